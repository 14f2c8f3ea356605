use super::*;
use crate::{
    bench::ChannelSettings,
    encoder::{EncoderConfig, PositionSource},
    line::LineConfig,
    test_receiver::TestReceiver,
    MS, US,
};
use endat_hdl::protocol::ModeCommand::SendPositionAddInfo;
use std::process::Command;

fn recorded() -> Bench<TestReceiver> {
    let encoder = EncoderConfig::endat22(13).position(PositionSource::Fixed(0x1234));
    let settings = ChannelSettings::new(100_000_000, 2_000_000, SendPositionAddInfo, 13);
    let link = Link::new(LineConfig::cable(20.0), encoder);
    let receiver = TestReceiver::new(100_000_000);
    let mut bench = Bench::channel(receiver, 100_000_000, &settings, link);
    bench.record_links();
    bench.watch("busy");
    bench.watch("position");
    bench.frame(MS);
    bench.frame(MS);
    bench.run_for(40 * US);
    bench
}

/// Content of a VCD.
struct Read {
    header: vcd::Header,
    commands: Vec<vcd::Command>,
}

impl Read {
    fn new(wave: &Wave) -> Self {
        let mut text = Vec::new();
        wave.write_vcd(&mut text).unwrap();
        let mut parser = vcd::Parser::new(text.as_slice());
        Self {
            header: parser.parse_header().unwrap(),
            commands: parser.map(Result::unwrap).collect(),
        }
    }

    /// Every change of a signal, as text.
    fn values(&self, path: &[&str], name: &str) -> Vec<(u64, String)> {
        let path = [path, &[name]].concat();
        let var = self.header.find_var(&path).expect("the signal exists");
        let mut changes: Vec<(u64, String)> = Vec::new();
        let mut now = 0;
        for command in &self.commands {
            let value = match command {
                vcd::Command::Timestamp(time) => {
                    now = *time;
                    continue;
                }
                vcd::Command::ChangeScalar(id, value) if *id == var.code => value.to_string(),
                vcd::Command::ChangeVector(id, value) if *id == var.code => value.to_string(),
                vcd::Command::ChangeString(id, value) if *id == var.code => value.clone(),
                _ => continue,
            };
            changes.push((now, value));
        }
        changes
    }

    /// Full names of all signals.
    fn names(&self) -> Vec<String> {
        fn of(items: &[vcd::ScopeItem], before: &str) -> Vec<String> {
            let each = items.iter().flat_map(|item| match item {
                vcd::ScopeItem::Var(var) => vec![format!("{before}{}", var.reference)],
                vcd::ScopeItem::Scope(scope) => {
                    of(&scope.items, &format!("{before}{}.", scope.identifier))
                }
                _ => Vec::new(),
            });
            each.collect()
        }
        of(&self.header.items, "")
    }
}

#[test]
fn the_vcd_reads_back_as_it_was() {
    let bench = recorded();
    let wave = Read::new(&Wave::of(&bench));
    let trace = bench.link(0).trace().unwrap();
    let clock = wave.values(&[TOP, "link0"], "clock");
    let expected = trace.clock_at_receiver.iter();
    let expected: Vec<_> = expected
        .map(|(t, v)| (*t, u8::from(*v).to_string()))
        .collect();
    assert_eq!(clock, expected);
    let position = wave.values(&[TOP, "design"], "position");
    assert_eq!(position.last().unwrap().1, format!("{:048b}", 0x1234));
    let driver: Vec<String> = wave
        .values(&[TOP, "link0"], "driver")
        .into_iter()
        .map(|v| v.1)
        .collect();
    let one_frame = ["encoder", "nobody", "receiver", "nobody"];
    let expected = [&one_frame[..], &one_frame[..], &["encoder"]].concat();
    assert_eq!(driver, expected);
    let meaning: Vec<String> = wave
        .values(&[TOP, "link0"], "meaning")
        .into_iter()
        .map(|v| v.1)
        .collect();
    let frame = "turnaround lead-in M5 M4 M3 M2 M1 M0 turnaround wait S F1 F2 D0 D1 D2 D3 D4 D5 D6 D7 D8 D9 D10 D11 D12 \
                 C4 C3 C2 C1 C0 recovery idle";
    assert_eq!(meaning.join(" "), format!("idle {frame} {frame}"));
    let data = wave.values(&[TOP, "link0"], "data");
    assert!(
        data.iter().any(|v| v.1 == "z"),
        "floating is not HIGH in a waveform"
    );
}

#[test]
fn the_layout_names_only_signals_of_the_vcd() {
    let bench = recorded();
    let wave = Wave::of(&bench);
    let known = Read::new(&wave).names();
    let layout = wave.gtkw("x.vcd");
    let prefix = format!("{TOP}.");
    let named: Vec<&str> = layout.lines().filter(|l| l.starts_with(&prefix)).collect();
    assert_eq!(named.len(), known.len());
    for name in named {
        let name = name.split('[').next().unwrap();
        assert!(known.iter().any(|k| k == name), "{name} not in {known:?}");
    }
}

/// GTKWave opens both files and shows every signal. It needs a display, so it runs under `xvfb-run`.
#[test]
fn gtkwave_shows_every_signal() {
    let present = |tool: &str| {
        Command::new("sh")
            .args(["-c", &format!("command -v {tool}")])
            .output()
            .is_ok_and(|o| o.status.success())
    };
    if !present("gtkwave") || !present("xvfb-run") {
        assert!(
            std::env::var_os("CI").is_none(),
            "CI is set: gtkwave and xvfb-run are required"
        );
        eprintln!("skipped: gtkwave or xvfb-run is not installed");
        return;
    }
    let dir = std::env::temp_dir().join(format!("endat-sim-wave-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    let wave = Wave::of(&recorded());
    let file = |name: &str| dir.join(name).to_str().unwrap().to_owned();
    wave.write_vcd(std::fs::File::create(file("f.vcd")).unwrap())
        .unwrap();
    std::fs::write(file("f.gtkw"), wave.gtkw("f.vcd")).unwrap();
    let script = "puts \"shown [gtkwave::getTotalNumTraces]\"\nforeach s [gtkwave::getDisplayedSignals] {puts \"trace $s\"}\n\
                  gtkwave::/File/Quit\n";
    std::fs::write(file("f.tcl"), script).unwrap();
    let out = Command::new("timeout")
        .args(["60", "xvfb-run", "-a", "gtkwave", "-S"])
        .args([file("f.tcl"), file("f.vcd"), file("f.gtkw")])
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&out.stdout).into_owned();
    std::fs::remove_dir_all(&dir).unwrap();
    let shown = text
        .lines()
        .filter(|l| l.starts_with("trace bench."))
        .count();
    assert_eq!(shown, 11, "{text}{}", String::from_utf8_lossy(&out.stderr));
}
