//! Decodes the results of all channels from the burst that reads them.

use endat_driver::{readings, Reading};
use endat_regs::Protocols;

/// The results of all channels, from the burst that reads them ([`endat_regs::result_words`]).
pub fn of_burst(
    words: &[u32],
    channels: usize,
    has_infos: bool,
    protocols: Protocols,
) -> Vec<Reading> {
    let all = readings(words, has_infos, protocols);
    all.take(channels).collect()
}

#[cfg(test)]
mod tests {
    use endat_driver::{AdditionalData as Info, Reading, RESULT_WORDS as WORDS};
    use endat_regs::Protocol;

    /// The bytes of the page are those of a card, including the fields next to the high bits of the position.
    #[test]
    fn the_examples_of_the_programming_page_are_results_that_fit() {
        let page = include_str!("../../docs/programming.md");
        let word = |line: &str| {
            let behind = line.rsplit("->").next().unwrap_or(line);
            let bytes = behind.split_whitespace().take(4);
            bytes.fold(0, |word, b| word << 8 | u32::from_str_radix(b, 16).unwrap())
        };
        let mut count = 0;
        let mut lines = page.lines();
        while let Some(line) = lines.next() {
            if !line.starts_with("02 03 00 00 01 80") {
                continue;
            }
            let mut words = [0; WORDS];
            for (to, line) in words
                .iter_mut()
                .zip([Some(line), lines.next(), lines.next()])
            {
                *to = word(line.unwrap());
            }
            let reading = Reading::new(&words, Protocol::Endat);
            assert!(words[2] >> 24 == 29 && reading.fits, "{words:x?}");
            assert_eq!(reading.position, 0x0123_5678);
            count += 1;
        }
        assert_eq!(count, 2);
    }

    #[test]
    fn the_example_of_the_host_link_page() {
        // Over F1 = 0, F2 = 1, 36 bits.
        let crc = 0x1A;
        let words = [
            0x00C0_0002,
            0x0123_5678,
            0x2400_0009 | 1 << 22 | crc << 16,
            77,
            (0x155 << 10) | (0x0A << 5) | 0x15,
            (1 << 30) | (1 << 29) | (0x123 << 16) | 500,
            0x0324_1234,
            0x0100_0000,
        ];
        let reading = Reading::new(&words, Protocol::Endat);
        assert_eq!(
            reading,
            Reading {
                sequence: 2,
                cause: 0,
                flags: 0,
                valid: true,
                fresh: true,
                position: 0x9_0123_5678,
                width_bits: 36,
                timestamp: 77,
                crc: [0x15, 0x0A],
                delay_cycles: 0x555,
                age_us: 500,
                stale: true,
                recovery_cycles: 0x123,
                special_bits: None,
                fits: true,
                infos: [
                    Info {
                        came: true,
                        good: true,
                        due: false,
                        status: 0x24,
                        content: 0x1234,
                    },
                    Info {
                        came: true,
                        ..Info::default()
                    },
                ],
            }
        );
        assert_eq!(reading.infos[0].number(), 4);
        assert_eq!(reading.cause_name(), "none");
        assert_eq!(reading.checked(), reading);
        // The same words in a channel with another protocol.
        let status = 0x00C2_0002;
        let named = |protocol: &Protocol| Reading::new(&[status], *protocol).cause_name();
        let names: Vec<_> = Protocol::ALL.iter().map(named).collect();
        assert_eq!(names, ["no_start_bit", "line_not_idle", "data_not_high"]);
        for bit in 0..36 {
            let mut spoilt = words;
            spoilt[1 + bit / 32] ^= 1 << (bit % 32);
            let checked = Reading::new(&spoilt, Protocol::Endat).checked();
            assert_eq!(
                (checked.valid, checked.fresh, checked.cause_name()),
                (false, false, "upset"),
                "{bit}"
            );
        }
    }
}
