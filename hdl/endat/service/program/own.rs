//! RAM words of the program.

use super::super::map::PLATE_DELAY;
use super::word;

const FIRST: u8 = 2 * word::PRIVATE;
pub const ZERO: u8 = FIRST;
/// Return addresses.
pub const FROM_EVENT: u8 = FIRST + 1;
pub const FROM_STORE: u8 = FIRST + 2;
pub const FROM_WAIT: u8 = FIRST + 3;
pub const FROM_OWN: u8 = FIRST + 4;
pub const FROM_INITIALISE: u8 = FIRST + 6;
/// Use of the request: see [`super::requests::mailbox`].
pub const MAILBOX: u8 = FIRST + 7;
/// Request.
pub const MODE: u8 = FIRST + 8;
pub const ADDRESS: u8 = FIRST + 9;
pub const DATA: u8 = FIRST + 10;
/// Way to send it.
pub const GO: u8 = FIRST + 11;
/// Cause and flags of its frame.
pub const RESULT: u8 = FIRST + 12;
pub const ERROR: u8 = FIRST + 13;
pub const BEGAN_US: u8 = FIRST + 14;
pub const BEGAN_MS: u8 = FIRST + 15;
pub const WAIT_FROM: u8 = FIRST + 16;
pub const WAIT_MS: u8 = FIRST + 17;
pub const OWN_FROM: u8 = FIRST + 18;
/// Levels at the control port.
pub const LEVELS: u8 = FIRST + 19;
/// State while an event is handled.
pub const STATUS: u8 = FIRST + 20;
pub const CODE: u8 = FIRST + 21;
pub const CONTENT: u8 = FIRST + 22;
pub const INDEX: u8 = FIRST + 23;
pub const NUMBER: u8 = FIRST + 24;
/// Additional data of the list have been received.
pub const MATCHED: u8 = FIRST + 25;
/// Bad frames among the last m, and their number; 2^(m-1); m.
pub const BAD: u8 = 2 * word::BAD_FRAMES;
pub const HISTORY: u8 = 2 * word::BAD_FRAMES + 1;
pub const LEAVING: u8 = FIRST + 26;
pub const WINDOW: u8 = FIRST + 27;
/// Place in the list of the last selected code.
pub const TURN: u8 = FIRST + 28;
/// Time since which DATA has been HIGH.
pub const HIGH_FROM: u8 = FIRST + 29;
pub const IS_HIGH: u8 = FIRST + 30;
/// Address and place of a word that is read.
pub const STEP: u8 = FIRST + 31;
pub const RETRIES: u8 = FIRST + 32;
pub const COUNT: u8 = FIRST + 33;
/// 32 bits.
pub const REST: u8 = FIRST + 34;
pub const DIVISOR: u8 = FIRST + 36;
/// Result, in the format of the port.
pub const FOUND: u8 = FIRST + 37;
/// Code of the next part of position 2; 0 = the first.
pub const STAGE: u8 = FIRST + 38;
/// 48 bits: the position for comparison with position 2.
pub const POSITION: u8 = FIRST + 39;
/// 64 bits: 2 to the power of the position's width; difference of the positions.
pub const MODULUS: u8 = FIRST + 42;
pub const DIFFERENCE: u8 = FIRST + 46;
/// 64 bits: remainder of the tolerance.
pub const MARGIN: u8 = FIRST + 50;
pub const FROM_FAILED: u8 = FIRST + 54;
pub const STEP_RETURN: u8 = FIRST + 55;
/// Frames until a request for a separate frame is sent again.
pub const PATIENCE: u8 = FIRST + 56;
/// Remaining restarts of the initialisation.
pub const ROUNDS: u8 = FIRST + 57;
/// Period from the initialisation; 0 = the configured one.
pub const PERIOD: u8 = FIRST + 58;
/// Words that control outputs and are rarely rewritten, and the address of each complement.
pub const KEPT: [(u8, u8); 3] = [
    (LEVELS, FIRST + 59),
    (FOUND, FIRST + 60),
    (PERIOD, FIRST + 61),
];
/// Words of the host that control frames, and the address of each complement.
pub const SET_FORCE: (u8, u8) = (2 * word::FORCE, GUARDS);
pub const SET_WATCHDOG: (u8, u8) = (2 * word::LIMITS, GUARDS + 1);
pub const SET_RECOVERY: (u8, u8) = (2 * word::LIMITS + 1, GUARDS + 2);
pub const SET_CONTINUOUS: (u8, u8) = (2 * word::CONTINUOUS, GUARDS + 3);
pub const SET_ERROR_TEST: (u8, u8) = (2 * word::ERROR_TEST, GUARDS + 4);
/// Address between the name plate and the program's other words.
const GUARDS: u8 = 2 * (PLATE_DELAY + 1);
const _: () = assert!(SET_ERROR_TEST.1 < FIRST);
/// Words of the forced errors, in front of the counters: time since the last one, the next one, its cause.
pub const TEST_FROM: u8 = 2 * word::COUNTERS - 1;
pub const TEST_NEXT: u8 = 2 * word::COUNTERS - 2;
pub const TEST_CAUSE: u8 = 2 * word::COUNTERS - 3;
/// A forced error is under way: its frame is not counted.
pub const TESTING: u8 = 2 * word::COUNTERS - 4;
/// A frame has just ended.
pub const BEHIND: u8 = 2 * word::COUNTERS - 5;
pub const FROM_TEST: u8 = 2 * word::COUNTERS - 6;
/// RAM has been cleared: two words that are unlikely by chance.
pub const CLEARED: [(u8, u16); 2] = [(FIRST + 62, 0xE2DA), (FIRST + 63, 0x1D25)];
