use super::*;
use protocol::{ModeCommand, MODE_COMMANDS};

#[path = "../tests/golden.rs"]
mod golden;

/// Every word of a card with two channels: name, address, access.
fn words() -> Vec<(String, u16, &'static str)> {
    let mut words = Vec::new();
    for block in BLOCKS {
        for channel in 0..if block.per_channel { 2 } else { 1 } {
            for r in block.registers {
                let n = if block.per_channel {
                    channel.to_string()
                } else {
                    String::new()
                };
                let name = format!("{}{n}_{}", block.name, r.name);
                words.push((name, block.address(r, channel), r.access.short()));
            }
        }
    }
    words
}

/// Compares with the committed list; `UPDATE_EXPECT` renews it. Its first line is the version of the map. A changed list needs a higher minor
/// version, from which a host derives the words of a card.
fn assert_golden(name: &str, now: &str) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("golden")
        .join(name);
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    if let Err(why) = check_version(&committed, now, VERSION) {
        panic!("{name}: {why}");
    }
    let [major, minor, _] = VERSION;
    golden::assert_committed(&path, &format!("map {major}.{minor}\n{now}"));
}

/// Checks the version rule: minor rises when a word or field is added.
fn check_version(committed: &str, now: &str, version: [u8; 3]) -> Result<(), String> {
    let (head, words) = committed.split_once('\n').unwrap_or_default();
    let [major, minor, _] = version;
    let next = format!("map {major}.{}", minor + 1);
    match head == format!("map {major}.{minor}") && words != now {
        true => Err(format!(
            "the map has changed, but not its version: set VERSION in regs/lib.rs to {next}, then renew the list"
        )),
        false => Ok(()),
    }
}

#[test]
fn a_new_word_needs_a_higher_minor_version() {
    let committed = "map 1.4\ncard_id 000 ro\n";
    let (same, more) = ("card_id 000 ro\n", "card_id 000 ro\ncard_new 001 ro\n");
    assert!(check_version(committed, same, [1, 4, 0]).is_ok());
    assert!(check_version(committed, more, [1, 5, 0]).is_ok());
    let why = check_version(committed, more, [1, 4, 9]).unwrap_err();
    assert!(why.contains("map 1.5"), "{why}");
}

#[test]
fn offsets_and_fields_are_where_they_have_always_been() {
    let text: String = words()
        .iter()
        .map(|(name, address, access)| format!("{name} {address:03X} {access}\n"))
        .collect();
    assert_golden("words.txt", &text);
    let registers = BLOCKS.iter().flat_map(|b| b.registers);
    let fields: String = registers
        .flat_map(|r| r.fields.iter().map(move |f| (r, f)))
        .map(|(r, f)| format!("{} {} {}:{}\n", r.name, f.name, f.lsb + f.width - 1, f.lsb))
        .collect();
    assert_golden("fields.txt", &fields);
}

#[test]
fn no_two_words_share_an_address_and_no_two_fields_a_bit() {
    let mut addresses: Vec<u16> = BLOCKS
        .iter()
        .flat_map(|b| {
            let channels = if b.per_channel { CHANNELS_MAX } else { 1 };
            (0..channels).flat_map(move |c| b.registers.iter().map(move |r| b.address(r, c)))
        })
        .collect();
    let n = addresses.len();
    addresses.sort_unstable();
    addresses.dedup();
    assert_eq!(addresses.len(), n);
    for register in BLOCKS.iter().flat_map(|b| b.registers) {
        let mut used = 0u32;
        for field in register.fields {
            assert!(field.lsb + field.width <= 32, "{}", register.name);
            assert_eq!(used & field.mask(), 0, "{} {}", register.name, field.name);
            used |= field.mask();
        }
    }
}

/// Catches a mode command whose text shows another code, and a missing one.
#[test]
fn commands_are_those_of_the_protocol() {
    for (listed, command) in MODE_COMMANDS.iter().zip(ModeCommand::ALL) {
        assert_eq!(listed.number, u32::from(command.code()), "{command:?}");
        let bits = format!("{:06b} ", command.code());
        assert!(listed.meaning.starts_with(&bits), "{}", listed.meaning);
    }
}

/// Catches a code that does not fit into its field, a duplicate name or number, and an identifier that a language reserves.
#[test]
fn values_fit_their_fields() {
    let fields = BLOCKS
        .iter()
        .flat_map(|b| b.registers)
        .flat_map(|r| r.fields);
    let mut lists = 0;
    let both = |field: &'static Field| {
        let others = field.values_elsewhere().map(|(_, values)| values);
        let all = core::iter::once(field.values).chain(others);
        all.map(move |v| (field, v))
    };
    for (field, values) in fields.flat_map(both) {
        let (listed, limit) = match values {
            Values::Plain => continue,
            Values::Codes(listed) => (listed, 1 << field.width),
            Values::Bits(listed) => (listed, field.width),
        };
        lists += 1;
        for (index, value) in listed.iter().enumerate() {
            assert!(value.number < limit, "{} {}", field.name, value.name);
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            assert!(value.name.starts_with(|c: char| c.is_ascii_lowercase()));
            assert!(value.name.chars().all(plain), "{}", value.name);
            let twin = |v: &Named| v.name == value.name || v.number == value.number;
            assert!(!listed[..index].iter().any(twin), "{}", value.name);
        }
    }
    assert_eq!(lists, 45);
}
