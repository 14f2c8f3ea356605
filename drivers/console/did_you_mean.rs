//! Suggests a name for a misspelt one. All user input shares one measure and one bound.

/// Longest name.
const NAME_MAX: usize = 64;

/// The names closest to a misspelt one, according to `text`; empty if none is close.
pub fn closest<T>(
    typed: &str,
    names: impl IntoIterator<Item = T>,
    text: impl Fn(&T) -> &str,
) -> Vec<T> {
    let mut found = Vec::new();
    if typed.len() > NAME_MAX {
        return found;
    }
    let names: Vec<T> = names.into_iter().collect();
    let is_begun = |name: &T| {
        let rest = text(name).strip_prefix(typed);
        rest.is_some_and(|rest| !typed.is_empty() && rest.starts_with('_'))
    };
    // The end of a name is missing, mostly its unit.
    if names.iter().filter(|name| is_begun(name)).count() == 1 {
        return names.into_iter().filter(is_begun).collect();
    }
    // One typing error, and one more for each four letters; two swapped letters count as one.
    let mut least = 1 + typed.len() / 4;
    for name in names {
        let distance = strsim::osa_distance(typed, text(&name));
        if distance < least {
            found.clear();
            least = distance;
        }
        if distance == least {
            found.push(name);
        }
    }
    found
}

/// `did you mean NAME?` with the closest name; `None` if none is close.
pub fn guess<'a>(typed: &str, names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let near = closest(typed, names, |name| name);
    near.first().map(|near| format!("did you mean {near}?"))
}

/// `did you mean A or B? ` with all names that are closest; empty if none is close.
pub fn guesses(typed: &str, names: impl IntoIterator<Item = String>) -> String {
    let near = closest(typed, names, |name| name);
    match near.is_empty() {
        true => String::new(),
        false => format!("did you mean {}? ", near.join(" or ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_guess_is_the_closest_name() {
        let guess = |typed| guess(typed, ["a1", "c1", "dd"]);
        assert_eq!(guess("b1").as_deref(), Some("did you mean a1?"));
        assert_eq!(guess("colour"), None);
    }

    #[test]
    fn a_slip_is_found_and_a_foreign_word_is_not() {
        let closest = |typed| closest(typed, ["clock_hz", "tst_ns", "cable_m"], |name| name);
        assert_eq!(closest("clok_hz"), ["clock_hz"]);
        assert_eq!(closest("clcok_hz"), ["clock_hz"]);
        assert_eq!(closest("tts_n"), ["tst_ns"]);
        assert_eq!(closest("cable"), ["cable_m"]);
        assert!(closest("colour").is_empty());
        assert!(closest("").is_empty());
        assert!(closest(&"clock_hz".repeat(9)).is_empty());
    }

    #[test]
    fn the_beginning_of_a_name_is_closer_than_another_word() {
        let names = ["bus", "base_address", "frames_good", "frames_crc"];
        let closest = |typed| closest(typed, names, |name| name);
        assert_eq!(closest("base"), ["base_address"]);
        assert_eq!(closest("frames"), [] as [&str; 0]);
    }

    #[test]
    fn all_that_are_equally_close_are_told() {
        assert_eq!(closest("b1", ["a1", "c1", "dd"], |name| name), ["a1", "c1"]);
    }
}
