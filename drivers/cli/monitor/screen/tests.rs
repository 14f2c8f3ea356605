use super::super::look::Frames;
use super::*;
use endat_driver::Reading;
use ratatui::backend::TestBackend;
use ratatui::Terminal;

fn facts(channels: usize) -> Facts {
    Facts {
        port: "/dev/ttyUSB1".into(),
        about: "2 channels, 100 MHz".into(),
        scales: vec![Scale::singleturn(29); channels],
        plates: vec!["  ID number         123456\n".into(), String::new()],
    }
}

fn seen(position: u64, cause: &'static str) -> Seen {
    Seen {
        reading: Reading {
            position,
            cause: endat_host::causes::number(cause).unwrap(),
            valid: true,
            fresh: cause == "none",
            age_us: 52,
            ..Reading::default()
        },
        rate_hz: Some(10_000.0),
        times: Some((120.0, 12.5)),
        frames: Some(Frames {
            all: 1_012,
            good: 1_000,
            causes: vec![("f1", 2), ("crc", 10)],
            bad_infos: 0,
        }),
        state: Some(vec!["initialised"]),
        edges: Some(Some((-2, 3))),
    }
}

fn screen(channels: usize) -> Screen {
    let mut screen = Screen::new(facts(channels), true);
    let one = |n: usize| match n {
        1 => seen(1 << 27, "crc"),
        n => seen((n as u64 + 1) << 26, "none"),
    };
    screen.look(Look {
        channels: (0..channels).map(one).collect(),
        retries: 0,
    });
    screen
}

fn terminal(screen: &Screen, width: u16, height: u16) -> Terminal<TestBackend> {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| draw(frame, screen)).unwrap();
    terminal
}

fn drawn(screen: &Screen, width: u16, height: u16) -> String {
    let terminal = terminal(screen, width, height);
    let cells = terminal
        .backend()
        .buffer()
        .content
        .chunks(width.max(1).into());
    let line = |cells: &[ratatui::buffer::Cell]| {
        let text: String = cells.iter().map(|cell| cell.symbol()).collect();
        text.trim_end().to_owned() + "\n"
    };
    cells.map(line).collect()
}

#[test]
fn a_terminal_of_80_by_24_shows_all_of_a_channel() {
    let wanted = "\
live  /dev/ttyUSB1  2 channels, 100 MHz
┌ positions ───────────────────────────────────────────────────────────────────┐
│  ch position                       per s  age us  result                     │
│> 0  45.0000000 deg                 10000      52  good                       │
│  1  90.0000000 deg                 10000      52  held: crc                  │
└──────────────────────────────────────────────────────────────────────────────┘
┌ channel 0 ─────────────────────────────────┐┌ frames by cause ───────────────┐
│raw               0x4000000                 ││all                         1012│
│line delay        120 ns                    ││good                        1000│
│recovery time     12.50 us                  ││crc                           10│
│edges             -2 to 3 places            ││f1                             2│
│state             initialised               ││                                │
│ID number         123456                    ││                                │
│                                            ││                                │
";
    let found = drawn(&screen(2), 80, 24);
    assert!(found.starts_with(wanted), "{found}");
    assert!(found.ends_with(&format!("{FOOT}\n")), "{found}");
}

/// Catches a verdict, a figure or a cause that is cut off beside an empty column.
#[test]
fn a_terminal_of_60_columns_shows_all_of_a_channel() {
    let wanted = "\
live  /dev/ttyUSB1  2 channels, 100 MHz
┌ positions ───────────────────────────────────────────────┐
│  ch position                     per s  age us  result   │
│> 0  45.0000000 deg               10000      52  good     │
│  1  90.0000000 deg               10000      52  held: crc│
└──────────────────────────────────────────────────────────┘
┌ channel 0 ───────────────────────────────────────────────┐
│raw               0x4000000                               │
│line delay        120 ns                                  │
│recovery time     12.50 us                                │
│edges             -2 to 3 places                          │
│state             initialised                             │
│ID number         123456                                  │
└──────────────────────────────────────────────────────────┘
┌ frames by cause ─────────────────────────────────────────┐
│all                         1012                          │
│good                        1000                          │
│crc                           10                          │
│f1                             2                          │
";
    let found = drawn(&screen(2), 60, 24);
    assert!(found.starts_with(wanted), "{found}");
    assert!(found.ends_with(&format!("{SHORT_FOOT}\n")), "{found}");
    // The longest name of a cause, and no room for all columns.
    let mut narrow = screen(1);
    let mut long = seen(1 << 26, "recovery_too_short");
    long.reading.fresh = false;
    narrow.look(Look {
        channels: vec![long],
        retries: 0,
    });
    let found = drawn(&narrow, 60, 24);
    assert!(found.contains("held: recovery_too_short"), "{found}");
}

#[test]
fn a_small_terminal_keeps_the_positions_and_none_is_too_small() {
    let wanted = "\
live  /dev/ttyUSB1  2 channe
  ch position         result
> 0  45.0000000 deg   good
  1  90.0000000 deg   held:
";
    assert_eq!(drawn(&screen(2), 28, 4), wanted);
    let mut screen = screen(8);
    screen.key(KeyCode::Char('?'), KeyModifiers::NONE);
    for width in [0, 1, 2, 7, 40, 300] {
        for height in 0..30 {
            drawn(&screen, width, height);
        }
    }
}

#[test]
fn keys_choose_zero_stop_help_and_end() {
    let mut screen = screen(2);
    let mut press = |code| screen.key(code, KeyModifiers::NONE);
    assert!(!press(KeyCode::Down) && !press(KeyCode::Down) && !press(KeyCode::Char('z')));
    assert!(!press(KeyCode::Char(' ')));
    let mut next = seen((1 << 27) - 4, "none");
    next.reading.position = (1 << 27) - 4;
    let look = Look {
        channels: vec![next.clone(), next],
        retries: 0,
    };
    // What is stopped shows nothing new.
    screen.look(look.clone());
    let found = drawn(&screen, 80, 24);
    assert!(found.starts_with("stopped, space goes on"), "{found}");
    assert!(found.contains("> 1  +0.0000000 deg z"), "{found}");
    screen.key(KeyCode::Char(' '), KeyModifiers::NONE);
    screen.look(look);
    let found = drawn(&screen, 80, 24);
    assert!(found.contains("> 1  -0.0000027 deg z"), "{found}");
    assert!(found.contains("  0  89.9999973 deg"), "{found}");
    screen.key(KeyCode::Char('Z'), KeyModifiers::SHIFT);
    assert!(!drawn(&screen, 80, 24).contains("deg z"));
    screen.key(KeyCode::Char('?'), KeyModifiers::NONE);
    assert!(drawn(&screen, 80, 24).contains("its position is 0 from here on"));
    // Any key takes the help away, and does nothing else.
    assert!(!screen.key(KeyCode::Char('q'), KeyModifiers::NONE));
    assert!(screen.key(KeyCode::Char('q'), KeyModifiers::NONE));
    assert!(screen.key(KeyCode::Char('c'), KeyModifiers::CONTROL));
}

#[test]
fn a_card_that_does_not_answer_is_told_and_what_was_seen_stays() {
    let mut screen = screen(2);
    screen.trouble("the card does not answer".into());
    let found = drawn(&screen, 80, 24);
    assert!(
        found.starts_with("the card does not answer  /dev"),
        "{found}"
    );
    assert!(found.contains("45.0000000 deg"), "{found}");
}

#[test]
fn without_colour_there_is_none() {
    let coloured = |has_colour| {
        let mut screen = screen(2);
        screen.has_colour = has_colour;
        let terminal = terminal(&screen, 80, 24);
        let mut cells = terminal.backend().buffer().content.iter();
        cells.any(|cell| cell.fg != Color::Reset || cell.bg != Color::Reset)
    };
    assert_eq!([true, false].map(coloured), [true, false]);
}
