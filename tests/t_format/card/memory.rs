//! The EEPROM of a T-format encoder, while triggers go on.

use super::*;
use endat_hdl::protocols::t_format::cause;
use endat_hdl::protocols::t_format::protocol::EEPROM_PAGE_ADDRESS;
use endat_sim::rng::Rng;

#[test]
fn bytes_are_written_and_read_back_while_triggers_run() {
    let config = EncoderConfig {
        status: 0,
        write_time: 300 * US,
        ..EncoderConfig::default()
    };
    let mut rig = Rig::with(false, "\"timer\"", "", config);
    let mut rng = Rng::new(3);
    rig.us(450);
    let (mut results, mut overruns, mut busy, mut last) = (0, 0, 0, rig.result(1).sequence);
    let mut look = |rig: &mut Rig| {
        let seen = rig.result(1);
        if seen.sequence != last {
            last = seen.sequence;
            results += 1;
            overruns += usize::from(seen.cause == cause::TRIGGER_OVERRUN);
            assert!(
                [0, cause::TRIGGER_OVERRUN].contains(&seen.cause),
                "{seen:?}"
            );
            assert!(seen.fresh);
        }
    };
    let mut known = 0;
    // Until the memory has time for it; the data of a busy one mean nothing, and leave those of the answer before.
    let mut done = |rig: &mut Rig, id: u8, address: u8, data: u8| loop {
        rig.us(rng.in_range(0, 60));
        look(rig);
        let answer = rig.request(id, address, data);
        look(rig);
        assert_eq!(answer.id, id, "{answer:?}");
        if answer.cause == cause::NONE {
            known = answer.data;
            return answer.data;
        }
        let told = (answer.cause, answer.data);
        assert_eq!(told, (cause::EEPROM_BUSY, known), "{answer:?}");
        busy += 1;
    };
    let byte = |page: u8, address: u8| page.wrapping_mul(37) ^ address.wrapping_mul(11) ^ 0x5A;
    for page in [2, 5] {
        done(&mut rig, 6, EEPROM_PAGE_ADDRESS, page);
        for address in [0, 1, 63, 126] {
            let data = byte(page, address);
            assert_eq!(done(&mut rig, 6, address, data), data);
        }
        for address in [0, 1, 63, 126] {
            assert_eq!(done(&mut rig, 13, address, 0), byte(page, address));
            let encoder = rig.master.bench.t_format(0).encoder();
            assert_eq!(encoder.eeprom(page, address), byte(page, address));
        }
    }
    assert!(results > 20 && busy > 5, "{results} {busy}");
    assert!(
        overruns > 0 && overruns < results,
        "{overruns} of {results}"
    );
    // Triggers have sent their own request all the time.
    let requests = rig.master.bench.t_format(0).encoder().requests();
    let triggered = requests.iter().filter(|r| r[..] == [0x1A]).count();
    assert!(triggered >= results, "{triggered} {results}");
    rig.check_encoders();
}

#[test]
fn the_fields_of_a_request_can_be_read_and_give_no_result() {
    let config = EncoderConfig {
        encoder_id: 0x37,
        status: 0x21,
        alarm: 0xC8,
        ..EncoderConfig::default()
    };
    let mut rig = Rig::with(true, "\"register\"", "", config);
    let fields = at(&T_FORMAT, "fields", 0);
    assert_eq!(rig.master.read(fields), 0);
    rig.us(30);
    let answer = rig.request(2, 0, 0);
    // The battery's alarm is harmless, and told.
    assert_eq!((answer.id, answer.cause), (2, cause::MULTI_TURN_ALARM));
    let reply = rig.master.bench.t_format(0).encoder().replies()[0].clone();
    let word = rig.master.read(fields);
    assert_eq!(word.to_le_bytes(), [0x21, 0x37, 0, reply[3]]);
    rig.request(3, 0, 0);
    let word = rig.master.read(fields);
    assert_eq!(word.to_le_bytes()[..3], [0x21, 0x37, 0xC8]);
    assert_eq!(rig.result(0).sequence, 0, "no trigger, no result");
    assert_eq!(rig.master.read(at(&T_FORMAT, "parts", 0)), 0);
    rig.check_encoders();
}
