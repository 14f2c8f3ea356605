/**
 * @file endat_map.h
 * Register map 1.1.0 of every card, whatever its configuration.
 *
 * Written by endat-gen from its register table. Do not edit: UPDATE_EXPECT=1 cargo test --test cards driver writes it again.
 *
 * ..._WORD counts words of 32 bits, ..._BYTE bytes: 4 * ..._WORD. Of blocks that each channel has, both take the channel.
 */
#ifndef ENDAT_MAP_H
#define ENDAT_MAP_H

/* Version of the register map; within a major version no address and no field moves. */
#define ENDAT_MAP_MAJOR 1u
#define ENDAT_MAP_MINOR 1u
#define ENDAT_MAP_PATCH 0u
/* Encoder ports of the largest card */
#define ENDAT_MAP_CHANNELS_MAX 8u
/* Bytes that the largest map takes */
#define ENDAT_MAP_BYTES 0x2000u
/* What card.id reads as */
#define ENDAT_MAP_ID 0x456E4474u
/* Words of a result; on cards with requests its additional data follow */
#define ENDAT_MAP_RESULT_WORDS 6u
#define ENDAT_MAP_RESULT_WORDS_WITH_INFOS 8u

/* How often in a row a T-format encoder takes a request that clears something */
#define ENDAT_MAP_T_FORMAT_RESETS_IN_A_ROW 10u

/* Content of a field in a word that was read, and a field's content as part of a word to be written. */
#define ENDAT_MAP_GET(field, word) (((word) & field##_MASK) >> field##_SHIFT)
#define ENDAT_MAP_PUT(field, value) (((value) << field##_SHIFT) & field##_MASK)

/* ---- card ------------------------------------------------------------------ */

/* Identification, capabilities, counters and strobes. */
#define ENDAT_MAP_CARD_BASE_WORD 0x000u
#define ENDAT_MAP_CARD_BASE_BYTE 0x0000u

/* ro: Identification: the ASCII letters EnDt. */
#define ENDAT_MAP_CARD_ID_WORD 0x000u
#define ENDAT_MAP_CARD_ID_BYTE 0x0000u
/* value: 0x456E4474 */
#define ENDAT_MAP_CARD_ID_VALUE_SHIFT 0u
#define ENDAT_MAP_CARD_ID_VALUE_MASK 0xFFFFFFFFu

/* ro: Version of the register map; offsets never move within a major version. */
#define ENDAT_MAP_CARD_VERSION_WORD 0x001u
#define ENDAT_MAP_CARD_VERSION_BYTE 0x0004u
/* patch: Patch */
#define ENDAT_MAP_CARD_VERSION_PATCH_SHIFT 0u
#define ENDAT_MAP_CARD_VERSION_PATCH_MASK 0x0000FFFFu
/* minor: Minor */
#define ENDAT_MAP_CARD_VERSION_MINOR_SHIFT 16u
#define ENDAT_MAP_CARD_VERSION_MINOR_MASK 0x00FF0000u
/* major: Major */
#define ENDAT_MAP_CARD_VERSION_MAJOR_SHIFT 24u
#define ENDAT_MAP_CARD_VERSION_MAJOR_MASK 0xFF000000u

/* ro: Features of this card. */
#define ENDAT_MAP_CARD_CAPABILITIES_WORD 0x002u
#define ENDAT_MAP_CARD_CAPABILITIES_BYTE 0x0008u
/* channels: Encoder ports */
#define ENDAT_MAP_CARD_CAPABILITIES_CHANNELS_SHIFT 0u
#define ENDAT_MAP_CARD_CAPABILITIES_CHANNELS_MASK 0x000000FFu
/* max_position_bits: Widest position (bits) */
#define ENDAT_MAP_CARD_CAPABILITIES_MAX_POSITION_BITS_SHIFT 8u
#define ENDAT_MAP_CARD_CAPABILITIES_MAX_POSITION_BITS_MASK 0x0000FF00u
/* features: Parts */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_SHIFT 16u
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_MASK 0xFFFF0000u
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_ENDAT22 0x1u /* EnDat 2.2 position frames (111000) */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_LINE_DELAY 0x2u /* line delay is measured */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_TRIGGER_PIN 0x4u /* trigger pin */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_TRIGGER_TIMER 0x8u /* trigger timer */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_REQUESTS 0x10u /* requests */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INITIALISE 0x20u /* initialisation */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_DIAGNOSIS 0x40u /* diagnosis of the line */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_CONTINUOUS 0x80u /* continuous clock */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_ALIGNMENT 0x100u /* selectable sampling phase, mean of many edges */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_MARGIN 0x200u /* timing margin of the samples */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_DOUBLE_EDGE 0x400u /* DATA sampled on both edges of the system clock */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_STREAM 0x800u /* stream of sample sets */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_DIRECT 0x1000u /* direct outputs */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_INTERRUPT 0x2000u /* interrupt */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_T_FORMAT 0x4000u /* T-format channels */
#define ENDAT_MAP_CARD_CAPABILITIES_FEATURES_OWN_TRIGGER 0x8000u /* enable, divider and trigger sources for each channel */

/* ro: System clock: the unit of every number of cycles. */
#define ENDAT_MAP_CARD_SYSTEM_HZ_WORD 0x003u
#define ENDAT_MAP_CARD_SYSTEM_HZ_BYTE 0x000Cu
/* value: Frequency (Hz) */
#define ENDAT_MAP_CARD_SYSTEM_HZ_VALUE_SHIFT 0u
#define ENDAT_MAP_CARD_SYSTEM_HZ_VALUE_MASK 0xFFFFFFFFu

/* ro: Hash of the configuration from which the card was generated. */
#define ENDAT_MAP_CARD_CONFIGURATION_HASH_WORD 0x004u
#define ENDAT_MAP_CARD_CONFIGURATION_HASH_BYTE 0x0010u
/* value: First 8 digits of the configuration hash in the generated files */
#define ENDAT_MAP_CARD_CONFIGURATION_HASH_VALUE_SHIFT 0u
#define ENDAT_MAP_CARD_CONFIGURATION_HASH_VALUE_MASK 0xFFFFFFFFu

/* ro: Channels with another protocol than EnDat, content of stream sets, further features. */
#define ENDAT_MAP_CARD_PROTOCOLS_WORD 0x005u
#define ENDAT_MAP_CARD_PROTOCOLS_BYTE 0x0014u
/* t_format: T-format: bit n for channel n */
#define ENDAT_MAP_CARD_PROTOCOLS_T_FORMAT_SHIFT 0u
#define ENDAT_MAP_CARD_PROTOCOLS_T_FORMAT_MASK 0x000000FFu
/* stream_additional_data: 1: stream sets include additional data */
#define ENDAT_MAP_CARD_PROTOCOLS_STREAM_ADDITIONAL_DATA_SHIFT 8u
#define ENDAT_MAP_CARD_PROTOCOLS_STREAM_ADDITIONAL_DATA_MASK 0x00000100u
/* features: Features that do not fit into capabilities.features */
#define ENDAT_MAP_CARD_PROTOCOLS_FEATURES_SHIFT 16u
#define ENDAT_MAP_CARD_PROTOCOLS_FEATURES_MASK 0x00FF0000u
#define ENDAT_MAP_CARD_PROTOCOLS_FEATURES_RECOVERY_COUNTER 0x1u /* recovery time measured independently */
#define ENDAT_MAP_CARD_PROTOCOLS_FEATURES_SECOND_INTERFACE 0x2u /* results for a second controller, over a read-only SPI */
#define ENDAT_MAP_CARD_PROTOCOLS_FEATURES_SECOND_RECEIVER 0x4u /* second receiver in lockstep */
#define ENDAT_MAP_CARD_PROTOCOLS_FEATURES_ERROR_TEST 0x8u /* forced errors on a schedule */
/* ssi: SSI: bit n for channel n */
#define ENDAT_MAP_CARD_PROTOCOLS_SSI_SHIFT 24u
#define ENDAT_MAP_CARD_PROTOCOLS_SSI_MASK 0xFF000000u

/* ro: Triggers since reset; frozen while the results are held (see hold). */
#define ENDAT_MAP_CARD_TRIGGER_COUNT_WORD 0x008u
#define ENDAT_MAP_CARD_TRIGGER_COUNT_BYTE 0x0020u
/* value: Wraps */
#define ENDAT_MAP_CARD_TRIGGER_COUNT_VALUE_SHIFT 0u
#define ENDAT_MAP_CARD_TRIGGER_COUNT_VALUE_MASK 0xFFFFFFFFu

/* strobe: Triggers all channels that accept it, if sources enables the register. */
#define ENDAT_MAP_CARD_TRIGGER_NOW_WORD 0x009u
#define ENDAT_MAP_CARD_TRIGGER_NOW_BYTE 0x0024u
/* trigger: Write 1 */
#define ENDAT_MAP_CARD_TRIGGER_NOW_TRIGGER_SHIFT 0u
#define ENDAT_MAP_CARD_TRIGGER_NOW_TRIGGER_MASK 0x00000001u

/* strobe: Channels measure their line delay again with their next frame. */
#define ENDAT_MAP_CARD_CALIBRATE_WORD 0x00Au
#define ENDAT_MAP_CARD_CALIBRATE_BYTE 0x0028u
/* channels: Bit n for channel n */
#define ENDAT_MAP_CARD_CALIBRATE_CHANNELS_SHIFT 0u
#define ENDAT_MAP_CARD_CALIBRATE_CHANNELS_MASK 0x000000FFu

/* rw: Enables of the sample stream. */
#define ENDAT_MAP_CARD_STREAM_CONTROL_WORD 0x00Cu
#define ENDAT_MAP_CARD_STREAM_CONTROL_BYTE 0x0030u
/* collect: 1: triggers produce sets */
#define ENDAT_MAP_CARD_STREAM_CONTROL_COLLECT_SHIFT 0u
#define ENDAT_MAP_CARD_STREAM_CONTROL_COLLECT_MASK 0x00000001u
/* push: 1: the UART sends frames */
#define ENDAT_MAP_CARD_STREAM_CONTROL_PUSH_SHIFT 1u
#define ENDAT_MAP_CARD_STREAM_CONTROL_PUSH_MASK 0x00000002u

/* ro: Fill level of the stream buffer, and lost sets. */
#define ENDAT_MAP_CARD_STREAM_STATE_WORD 0x00Du
#define ENDAT_MAP_CARD_STREAM_STATE_BYTE 0x0034u
/* bytes: Bytes in the buffer (bytes) */
#define ENDAT_MAP_CARD_STREAM_STATE_BYTES_SHIFT 0u
#define ENDAT_MAP_CARD_STREAM_STATE_BYTES_MASK 0x0000FFFFu
/* lost: Sets lost since clear; stops at 65535 */
#define ENDAT_MAP_CARD_STREAM_STATE_LOST_SHIFT 16u
#define ENDAT_MAP_CARD_STREAM_STATE_LOST_MASK 0xFFFF0000u

/* ro: Reads and removes the next bytes of the stream from the buffer. */
#define ENDAT_MAP_CARD_STREAM_DATA_WORD 0x00Eu
#define ENDAT_MAP_CARD_STREAM_DATA_BYTE 0x0038u
/* bytes: First byte in bits 31..24; missing bytes read 0 */
#define ENDAT_MAP_CARD_STREAM_DATA_BYTES_SHIFT 0u
#define ENDAT_MAP_CARD_STREAM_DATA_BYTES_MASK 0xFFFFFFFFu

/* strobe: Empties the buffer and clears stream_status.lost. */
#define ENDAT_MAP_CARD_STREAM_CLEAR_WORD 0x00Fu
#define ENDAT_MAP_CARD_STREAM_CLEAR_BYTE 0x003Cu
/* clear: Write 1 */
#define ENDAT_MAP_CARD_STREAM_CLEAR_CLEAR_SHIFT 0u
#define ENDAT_MAP_CARD_STREAM_CLEAR_CLEAR_MASK 0x00000001u

/* ---- interrupt ------------------------------------------------------------- */

/* Interrupt: irq_o is high while a bit is set in both status and mask. */
#define ENDAT_MAP_INTERRUPT_BASE_WORD 0x010u
#define ENDAT_MAP_INTERRUPT_BASE_BYTE 0x0040u

/* ro: Events since cleared. */
#define ENDAT_MAP_INTERRUPT_STATUS_WORD 0x010u
#define ENDAT_MAP_INTERRUPT_STATUS_BYTE 0x0040u
/* channel_0: Events of the channel */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_0_SHIFT 0u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_0_MASK 0x0000000Fu
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_0_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_0_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_0_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_0_REQUEST 0x8u /* the frame of a request ended */
/* channel_1: Events of the channel */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_1_SHIFT 4u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_1_MASK 0x000000F0u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_1_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_1_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_1_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_1_REQUEST 0x8u /* the frame of a request ended */
/* channel_2: Events of the channel */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_2_SHIFT 8u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_2_MASK 0x00000F00u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_2_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_2_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_2_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_2_REQUEST 0x8u /* the frame of a request ended */
/* channel_3: Events of the channel */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_3_SHIFT 12u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_3_MASK 0x0000F000u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_3_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_3_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_3_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_3_REQUEST 0x8u /* the frame of a request ended */
/* channel_4: Events of the channel */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_4_SHIFT 16u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_4_MASK 0x000F0000u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_4_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_4_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_4_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_4_REQUEST 0x8u /* the frame of a request ended */
/* channel_5: Events of the channel */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_5_SHIFT 20u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_5_MASK 0x00F00000u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_5_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_5_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_5_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_5_REQUEST 0x8u /* the frame of a request ended */
/* channel_6: Events of the channel */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_6_SHIFT 24u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_6_MASK 0x0F000000u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_6_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_6_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_6_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_6_REQUEST 0x8u /* the frame of a request ended */
/* channel_7: Events of the channel */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_7_SHIFT 28u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_7_MASK 0xF0000000u
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_7_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_7_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_7_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_STATUS_CHANNEL_7_REQUEST 0x8u /* the frame of a request ended */

/* rw: Events that assert irq_o. */
#define ENDAT_MAP_INTERRUPT_MASK_WORD 0x011u
#define ENDAT_MAP_INTERRUPT_MASK_BYTE 0x0044u
/* channel_0: Events of the channel */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_0_SHIFT 0u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_0_MASK 0x0000000Fu
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_0_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_0_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_0_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_0_REQUEST 0x8u /* the frame of a request ended */
/* channel_1: Events of the channel */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_1_SHIFT 4u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_1_MASK 0x000000F0u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_1_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_1_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_1_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_1_REQUEST 0x8u /* the frame of a request ended */
/* channel_2: Events of the channel */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_2_SHIFT 8u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_2_MASK 0x00000F00u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_2_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_2_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_2_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_2_REQUEST 0x8u /* the frame of a request ended */
/* channel_3: Events of the channel */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_3_SHIFT 12u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_3_MASK 0x0000F000u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_3_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_3_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_3_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_3_REQUEST 0x8u /* the frame of a request ended */
/* channel_4: Events of the channel */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_4_SHIFT 16u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_4_MASK 0x000F0000u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_4_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_4_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_4_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_4_REQUEST 0x8u /* the frame of a request ended */
/* channel_5: Events of the channel */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_5_SHIFT 20u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_5_MASK 0x00F00000u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_5_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_5_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_5_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_5_REQUEST 0x8u /* the frame of a request ended */
/* channel_6: Events of the channel */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_6_SHIFT 24u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_6_MASK 0x0F000000u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_6_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_6_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_6_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_6_REQUEST 0x8u /* the frame of a request ended */
/* channel_7: Events of the channel */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_7_SHIFT 28u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_7_MASK 0xF0000000u
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_7_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_7_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_7_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_MASK_CHANNEL_7_REQUEST 0x8u /* the frame of a request ended */

/* strobe: Clears the bits of status that are written 1; an event in the same cycle remains. */
#define ENDAT_MAP_INTERRUPT_CLEAR_WORD 0x012u
#define ENDAT_MAP_INTERRUPT_CLEAR_BYTE 0x0048u
/* channel_0: Events of the channel */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_0_SHIFT 0u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_0_MASK 0x0000000Fu
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_0_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_0_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_0_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_0_REQUEST 0x8u /* the frame of a request ended */
/* channel_1: Events of the channel */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_1_SHIFT 4u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_1_MASK 0x000000F0u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_1_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_1_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_1_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_1_REQUEST 0x8u /* the frame of a request ended */
/* channel_2: Events of the channel */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_2_SHIFT 8u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_2_MASK 0x00000F00u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_2_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_2_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_2_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_2_REQUEST 0x8u /* the frame of a request ended */
/* channel_3: Events of the channel */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_3_SHIFT 12u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_3_MASK 0x0000F000u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_3_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_3_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_3_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_3_REQUEST 0x8u /* the frame of a request ended */
/* channel_4: Events of the channel */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_4_SHIFT 16u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_4_MASK 0x000F0000u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_4_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_4_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_4_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_4_REQUEST 0x8u /* the frame of a request ended */
/* channel_5: Events of the channel */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_5_SHIFT 20u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_5_MASK 0x00F00000u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_5_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_5_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_5_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_5_REQUEST 0x8u /* the frame of a request ended */
/* channel_6: Events of the channel */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_6_SHIFT 24u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_6_MASK 0x0F000000u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_6_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_6_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_6_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_6_REQUEST 0x8u /* the frame of a request ended */
/* channel_7: Events of the channel */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_7_SHIFT 28u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_7_MASK 0xF0000000u
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_7_RESULT 0x1u /* a new result */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_7_ERROR 0x2u /* a result with one of the causes in direct.error_causes */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_7_ALARM 0x4u /* the alarm was set */
#define ENDAT_MAP_INTERRUPT_CLEAR_CHANNEL_7_REQUEST 0x8u /* the frame of a request ended */

/* ---- recovery -------------------------------------------------------------- */

/* Recovery time of a channel, measured independently of the core: a free-running counter, captured at the edges. Not valid for T-format channels. */
#define ENDAT_MAP_RECOVERY_BASE_WORD 0x040u
#define ENDAT_MAP_RECOVERY_BASE_BYTE 0x0100u
#define ENDAT_MAP_RECOVERY_STRIDE_WORDS 8u
#define ENDAT_MAP_RECOVERY_STRIDE_BYTES 32u

/* ro: Counter at the edges that begin and end the recovery time; the difference, modulo 65536, is that time plus the line delay. */
#define ENDAT_MAP_RECOVERY_EDGES_WORD(channel) (0x040u + 8u * (channel))
#define ENDAT_MAP_RECOVERY_EDGES_BYTE(channel) (0x0100u + 32u * (channel))
/* rise: At the last rising edge of CLOCK (cycles) */
#define ENDAT_MAP_RECOVERY_EDGES_RISE_SHIFT 0u
#define ENDAT_MAP_RECOVERY_EDGES_RISE_MASK 0x0000FFFFu
/* fall: At the last falling edge of DATA while the receiver's driver was off (cycles) */
#define ENDAT_MAP_RECOVERY_EDGES_FALL_SHIFT 16u
#define ENDAT_MAP_RECOVERY_EDGES_FALL_MASK 0xFFFF0000u

/* ro: Current counter value; two reads with the same value mean that the counter has stopped: a fault. */
#define ENDAT_MAP_RECOVERY_COUNTER_WORD(channel) (0x041u + 8u * (channel))
#define ENDAT_MAP_RECOVERY_COUNTER_BYTE(channel) (0x0104u + 32u * (channel))
/* value: Starts at 8192 times the channel number (cycles) */
#define ENDAT_MAP_RECOVERY_COUNTER_VALUE_SHIFT 0u
#define ENDAT_MAP_RECOVERY_COUNTER_VALUE_MASK 0x0000FFFFu
/* fallen: DATA has fallen since the last rising edge of CLOCK, and is LOW */
#define ENDAT_MAP_RECOVERY_COUNTER_FALLEN_SHIFT 16u
#define ENDAT_MAP_RECOVERY_COUNTER_FALLEN_MASK 0x00010000u

/* ---- direct ---------------------------------------------------------------- */

/* Direct outputs of a channel: position slice and selection of errors. */
#define ENDAT_MAP_DIRECT_BASE_WORD 0x080u
#define ENDAT_MAP_DIRECT_BASE_BYTE 0x0200u
#define ENDAT_MAP_DIRECT_STRIDE_WORDS 8u
#define ENDAT_MAP_DIRECT_STRIDE_BYTES 32u

/* rw: Position bits at the output; takes effect with the next result. */
#define ENDAT_MAP_DIRECT_CROP_WORD(channel) (0x080u + 8u * (channel))
#define ENDAT_MAP_DIRECT_CROP_BYTE(channel) (0x0200u + 32u * (channel))
/* first_bit: Position bit that becomes bit 0, 0..47 */
#define ENDAT_MAP_DIRECT_CROP_FIRST_BIT_SHIFT 0u
#define ENDAT_MAP_DIRECT_CROP_FIRST_BIT_MASK 0x0000003Fu
/* length_bits: Number of bits, 0..32; upper bits are 0 (bits) */
#define ENDAT_MAP_DIRECT_CROP_LENGTH_BITS_SHIFT 8u
#define ENDAT_MAP_DIRECT_CROP_LENGTH_BITS_MASK 0x00003F00u

/* rw: Causes that assert direct_error_o: bit k for cause k, bit 0 for the channel's alarm. */
#define ENDAT_MAP_DIRECT_ERROR_CAUSES_WORD(channel) (0x081u + 8u * (channel))
#define ENDAT_MAP_DIRECT_ERROR_CAUSES_BYTE(channel) (0x0204u + 32u * (channel))
/* causes: Causes counted as errors, judged at the last result */
#define ENDAT_MAP_DIRECT_ERROR_CAUSES_CAUSES_SHIFT 0u
#define ENDAT_MAP_DIRECT_ERROR_CAUSES_CAUSES_MASK 0xFFFFFFFFu

/* ---- t_format -------------------------------------------------------------- */

/* Requests to a T-format encoder in addition to triggers, and the fields of its replies; 0 on a channel with another protocol. */
#define ENDAT_MAP_T_FORMAT_BASE_WORD 0x0C0u
#define ENDAT_MAP_T_FORMAT_BASE_BYTE 0x0300u
#define ENDAT_MAP_T_FORMAT_STRIDE_WORDS 8u
#define ENDAT_MAP_T_FORMAT_STRIDE_BYTES 32u

/* strobe: Sends one request, now or when the exchange under way has ended; ignored while answer.busy. */
#define ENDAT_MAP_T_FORMAT_SEND_WORD(channel) (0x0C0u + 8u * (channel))
#define ENDAT_MAP_T_FORMAT_SEND_BYTE(channel) (0x0300u + 32u * (channel))
/* data: EEPROM data for request 6 */
#define ENDAT_MAP_T_FORMAT_SEND_DATA_SHIFT 0u
#define ENDAT_MAP_T_FORMAT_SEND_DATA_MASK 0x000000FFu
/* address: EEPROM address for requests 6 and 13; 127 is the page register */
#define ENDAT_MAP_T_FORMAT_SEND_ADDRESS_SHIFT 8u
#define ENDAT_MAP_T_FORMAT_SEND_ADDRESS_MASK 0x00007F00u
/* id: Request ID */
#define ENDAT_MAP_T_FORMAT_SEND_ID_SHIFT 16u
#define ENDAT_MAP_T_FORMAT_SEND_ID_MASK 0x000F0000u
#define ENDAT_MAP_T_FORMAT_SEND_ID_SINGLE_TURN 0u /* single-turn position */
#define ENDAT_MAP_T_FORMAT_SEND_ID_MULTI_TURN 1u /* multi-turn position */
#define ENDAT_MAP_T_FORMAT_SEND_ID_ENCODER_ID 2u /* kind of encoder */
#define ENDAT_MAP_T_FORMAT_SEND_ID_EVERYTHING 3u /* both positions, kind and alarms */
#define ENDAT_MAP_T_FORMAT_SEND_ID_WRITE_EEPROM 6u /* writes a byte of the EEPROM */
#define ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_ERRORS 7u /* clears errors, ten in a row */
#define ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_SINGLE_TURN 8u /* makes the present angle zero, ten in a row */
#define ENDAT_MAP_T_FORMAT_SEND_ID_CLEAR_MULTI_TURN 12u /* clears turns and errors, ten in a row */
#define ENDAT_MAP_T_FORMAT_SEND_ID_READ_EEPROM 13u /* reads a byte of the EEPROM */

/* ro: State and data of the request in send. */
#define ENDAT_MAP_T_FORMAT_ANSWER_WORD(channel) (0x0C1u + 8u * (channel))
#define ENDAT_MAP_T_FORMAT_ANSWER_BYTE(channel) (0x0304u + 32u * (channel))
/* data: EEPROM data of the last reply that had it */
#define ENDAT_MAP_T_FORMAT_ANSWER_DATA_SHIFT 0u
#define ENDAT_MAP_T_FORMAT_ANSWER_DATA_MASK 0x000000FFu
/* id: ID echoed in the reply */
#define ENDAT_MAP_T_FORMAT_ANSWER_ID_SHIFT 8u
#define ENDAT_MAP_T_FORMAT_ANSWER_ID_MASK 0x00000F00u
/* cause: T-format cause of the exchange */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_SHIFT 12u
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_MASK 0x0000F000u
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_NONE 0u /* none */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_UNKNOWN_COMMAND 1u /* unknown request */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_LINE_NOT_IDLE 2u /* line not idle */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_NO_ANSWER 3u /* no answer */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_NO_HEADER 4u /* no header */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_CONTROL_PARITY 5u /* parity of the control field */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_REPLY_ECHO 6u /* another ID or address in the reply */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_DELIMITER 7u /* delimiter */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_FIELD_MISSING 8u /* field missing */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_REPLY_CRC 9u /* CRC */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_REQUEST_PARITY 10u /* encoder saw a parity error */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_REQUEST_DELIMITER 11u /* encoder saw a delimiter error */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_EEPROM_BUSY 12u /* EEPROM busy */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_COUNTING_ERROR 13u /* counting error */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_MULTI_TURN_ALARM 14u /* multi-turn or battery alarm */
#define ENDAT_MAP_T_FORMAT_ANSWER_CAUSE_UPSET 15u /* stored data upset */
/* done: The exchange has ended; cleared by send */
#define ENDAT_MAP_T_FORMAT_ANSWER_DONE_SHIFT 16u
#define ENDAT_MAP_T_FORMAT_ANSWER_DONE_MASK 0x00010000u
/* busy: The exchange is under way or waiting */
#define ENDAT_MAP_T_FORMAT_ANSWER_BUSY_SHIFT 17u
#define ENDAT_MAP_T_FORMAT_ANSWER_BUSY_MASK 0x00020000u

/* ro: Fields of the last reply, to a trigger or to send. */
#define ENDAT_MAP_T_FORMAT_FIELDS_WORD(channel) (0x0C2u + 8u * (channel))
#define ENDAT_MAP_T_FORMAT_FIELDS_BYTE(channel) (0x0308u + 32u * (channel))
/* status: Status field (SF); 0 if none was received */
#define ENDAT_MAP_T_FORMAT_FIELDS_STATUS_SHIFT 0u
#define ENDAT_MAP_T_FORMAT_FIELDS_STATUS_MASK 0x000000FFu
/* encoder_id: Kind of encoder (ENID), last received */
#define ENDAT_MAP_T_FORMAT_FIELDS_ENCODER_ID_SHIFT 8u
#define ENDAT_MAP_T_FORMAT_FIELDS_ENCODER_ID_MASK 0x0000FF00u
/* alarm: Alarm field (ALMC), last received */
#define ENDAT_MAP_T_FORMAT_FIELDS_ALARM_SHIFT 16u
#define ENDAT_MAP_T_FORMAT_FIELDS_ALARM_MASK 0x00FF0000u
/* crc: CRC as received */
#define ENDAT_MAP_T_FORMAT_FIELDS_CRC_SHIFT 24u
#define ENDAT_MAP_T_FORMAT_FIELDS_CRC_MASK 0xFF000000u

/* ro: Parts of the position received since reset. */
#define ENDAT_MAP_T_FORMAT_PARTS_WORD(channel) (0x0C3u + 8u * (channel))
#define ENDAT_MAP_T_FORMAT_PARTS_BYTE(channel) (0x030Cu + 32u * (channel))
/* single_valid: Single-turn position received, bits 23..0 */
#define ENDAT_MAP_T_FORMAT_PARTS_SINGLE_VALID_SHIFT 0u
#define ENDAT_MAP_T_FORMAT_PARTS_SINGLE_VALID_MASK 0x00000001u
/* multi_valid: Multi-turn position received, bits 47..24 */
#define ENDAT_MAP_T_FORMAT_PARTS_MULTI_VALID_SHIFT 1u
#define ENDAT_MAP_T_FORMAT_PARTS_MULTI_VALID_MASK 0x00000002u

/* ---- card_config ----------------------------------------------------------- */

/* Configuration of the card. */
#define ENDAT_MAP_CARD_CONFIG_BASE_WORD 0x100u
#define ENDAT_MAP_CARD_CONFIG_BASE_BYTE 0x0400u

/* rw: Enabled trigger sources; one trigger starts all channels that accept it in the same clock cycle. */
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_WORD 0x100u
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_BYTE 0x0400u
/* pin: Rising edge of the trigger pin */
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_PIN_SHIFT 0u
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_PIN_MASK 0x00000001u
/* timer: Every trigger_period */
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_TIMER_SHIFT 1u
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_TIMER_MASK 0x00000002u
/* register: trigger_now */
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_SHIFT 2u
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_REGISTER_MASK 0x00000004u
/* disabled: Channels that ignore triggers, bit n for channel n; with part own_trigger only */
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_DISABLED_SHIFT 8u
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_SOURCES_DISABLED_MASK 0x0000FF00u

/* rw: Period of the timer, at least 4; write it while the timer is disabled. */
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_PERIOD_WORD 0x101u
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_PERIOD_BYTE 0x0404u
/* value: Period (cycles) */
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_PERIOD_VALUE_SHIFT 0u
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_PERIOD_VALUE_MASK 0x00FFFFFFu

/* rw: Holds the results of all channels, for a host that reads word by word. */
#define ENDAT_MAP_CARD_CONFIG_HOLD_WORD 0x102u
#define ENDAT_MAP_CARD_CONFIG_HOLD_BYTE 0x0408u
/* hold: 1: results and trigger_count are frozen */
#define ENDAT_MAP_CARD_CONFIG_HOLD_HOLD_SHIFT 0u
#define ENDAT_MAP_CARD_CONFIG_HOLD_HOLD_MASK 0x00000001u
/* scratch: Free for the host: link test of a driver, restart mark of a recording */
#define ENDAT_MAP_CARD_CONFIG_HOLD_SCRATCH_SHIFT 8u
#define ENDAT_MAP_CARD_CONFIG_HOLD_SCRATCH_MASK 0xFFFFFF00u

/* What value takes */
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_PERIOD_VALUE_MIN 4u
#define ENDAT_MAP_CARD_CONFIG_TRIGGER_PERIOD_VALUE_MAX 16777215u

/* ---- config ---------------------------------------------------------------- */

/* Configuration of a channel; takes effect between two frames. */
#define ENDAT_MAP_CONFIG_BASE_WORD 0x108u
#define ENDAT_MAP_CONFIG_BASE_BYTE 0x0420u
#define ENDAT_MAP_CONFIG_STRIDE_WORDS 8u
#define ENDAT_MAP_CONFIG_STRIDE_BYTES 32u

/* rw: Command to the encoder, and clock rate. */
#define ENDAT_MAP_CONFIG_FRAME_WORD(channel) (0x108u + 8u * (channel))
#define ENDAT_MAP_CONFIG_FRAME_BYTE(channel) (0x0420u + 32u * (channel))
/* period_cycles: EnDat clock period; if odd, the high phase is longer; T-format: a bit, 8..127 (cycles) */
#define ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_SHIFT 0u
#define ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_MASK 0x000007FFu
/* skip: Triggers to skip after each accepted one; with part own_trigger only, as the ignored sources */
#define ENDAT_MAP_CONFIG_FRAME_SKIP_SHIFT 11u
#define ENDAT_MAP_CONFIG_FRAME_SKIP_MASK 0x0000F800u
/* position_bits: Position width, 1..48; T-format: bits of angle and turns together if limits.range is rotary, else unused, as command (bits) */
#define ENDAT_MAP_CONFIG_FRAME_POSITION_BITS_SHIFT 16u
#define ENDAT_MAP_CONFIG_FRAME_POSITION_BITS_MASK 0x003F0000u
/* ignore_pin: 1: the channel ignores the trigger pin */
#define ENDAT_MAP_CONFIG_FRAME_IGNORE_PIN_SHIFT 22u
#define ENDAT_MAP_CONFIG_FRAME_IGNORE_PIN_MASK 0x00400000u
/* ignore_timer: 1: the channel ignores the timer */
#define ENDAT_MAP_CONFIG_FRAME_IGNORE_TIMER_SHIFT 23u
#define ENDAT_MAP_CONFIG_FRAME_IGNORE_TIMER_MASK 0x00800000u
/* command: Mode command, sent most significant bit first */
#define ENDAT_MAP_CONFIG_FRAME_COMMAND_SHIFT 24u
#define ENDAT_MAP_CONFIG_FRAME_COMMAND_MASK 0x3F000000u
#define ENDAT_MAP_CONFIG_FRAME_COMMAND_SEND_POSITION 7u /* 000111 send position (EnDat 2.1) */
#define ENDAT_MAP_CONFIG_FRAME_COMMAND_SEND_POSITION_ADD_INFO 56u /* 111000 send position with additional data (EnDat 2.2) */
/* command: on an SSI channel */
#define ENDAT_MAP_CONFIG_FRAME_COMMAND_SSI_GRAY 0x1u /* in Gray code */
#define ENDAT_MAP_CONFIG_FRAME_COMMAND_SSI_TWICE 0x2u /* each position sent twice and compared */
#define ENDAT_MAP_CONFIG_FRAME_COMMAND_SSI_CLOCKED 0x4u /* sends a frame; must be 1 */
#define ENDAT_MAP_CONFIG_FRAME_COMMAND_SSI_PARITY 0x8u /* a parity bit follows the position */
#define ENDAT_MAP_CONFIG_FRAME_COMMAND_SSI_ODD 0x10u /* the parity is odd */
/* ignore_register: 1: the channel ignores trigger_now */
#define ENDAT_MAP_CONFIG_FRAME_IGNORE_REGISTER_SHIFT 30u
#define ENDAT_MAP_CONFIG_FRAME_IGNORE_REGISTER_MASK 0x40000000u

/* rw: First low phase and tolerance of the start bit; bits that count turns. */
#define ENDAT_MAP_CONFIG_TIMING_WORD(channel) (0x109u + 8u * (channel))
#define ENDAT_MAP_CONFIG_TIMING_BYTE(channel) (0x0424u + 32u * (channel))
/* first_low_extra_cycles: First low phase minus half a period (tST) (cycles) */
#define ENDAT_MAP_CONFIG_TIMING_FIRST_LOW_EXTRA_CYCLES_SHIFT 0u
#define ENDAT_MAP_CONFIG_TIMING_FIRST_LOW_EXTRA_CYCLES_MASK 0x000007FFu
/* multi_turn_bits: Upper bits of the position that count turns, if limits.range is rotary; only the host uses it. T-format: of bits 47..24, up to 24 (bits) */
#define ENDAT_MAP_CONFIG_TIMING_MULTI_TURN_BITS_SHIFT 11u
#define ENDAT_MAP_CONFIG_TIMING_MULTI_TURN_BITS_MASK 0x0000F800u
/* start_window_cycles: Tolerance of the start edge around its expected phase (cycles) */
#define ENDAT_MAP_CONFIG_TIMING_START_WINDOW_CYCLES_SHIFT 16u
#define ENDAT_MAP_CONFIG_TIMING_START_WINDOW_CYCLES_MASK 0x003F0000u
/* filter_half: 1: half a cycle more; with part double_edge only */
#define ENDAT_MAP_CONFIG_TIMING_FILTER_HALF_SHIFT 23u
#define ENDAT_MAP_CONFIG_TIMING_FILTER_HALF_MASK 0x00800000u
/* filter_cycles: Pulses on DATA up to this length are ignored; 0 = off (cycles) */
#define ENDAT_MAP_CONFIG_TIMING_FILTER_CYCLES_SHIFT 24u
#define ENDAT_MAP_CONFIG_TIMING_FILTER_CYCLES_MASK 0x0F000000u
/* request_id: T-format: request ID of a trigger; 6 and 13 are rejected */
#define ENDAT_MAP_CONFIG_TIMING_REQUEST_ID_SHIFT 28u
#define ENDAT_MAP_CONFIG_TIMING_REQUEST_ID_MASK 0xF0000000u

/* rw: Timeouts; kind of position. */
#define ENDAT_MAP_CONFIG_LIMITS_WORD(channel) (0x10Au + 8u * (channel))
#define ENDAT_MAP_CONFIG_LIMITS_BYTE(channel) (0x0428u + 32u * (channel))
/* start_timeout_us: Longest wait for the start bit after the turnaround; T-format: longest pause before the reply, 1..63 (us) */
#define ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US_SHIFT 0u
#define ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US_MASK 0x00000FFFu
/* range: Kind of position; only the host uses it */
#define ENDAT_MAP_CONFIG_LIMITS_RANGE_SHIFT 12u
#define ENDAT_MAP_CONFIG_LIMITS_RANGE_MASK 0x00003000u
#define ENDAT_MAP_CONFIG_LIMITS_RANGE_UNKNOWN 0u /* not given here; the name plate may have it */
#define ENDAT_MAP_CONFIG_LIMITS_RANGE_ROTARY 1u /* multi_turn_bits count turns, the bits below them the angle */
#define ENDAT_MAP_CONFIG_LIMITS_RANGE_LINEAR 2u /* no turn bits; the position does not wrap */
/* recovery_limit_cycles: DATA must fall within this time after the frame (tm) (cycles) */
#define ENDAT_MAP_CONFIG_LIMITS_RECOVERY_LIMIT_CYCLES_SHIFT 16u
#define ENDAT_MAP_CONFIG_LIMITS_RECOVERY_LIMIT_CYCLES_MASK 0x1FFF0000u
/* field_gap_us: T-format: longest pause between two fields (us) */
#define ENDAT_MAP_CONFIG_LIMITS_FIELD_GAP_US_SHIFT 29u
#define ENDAT_MAP_CONFIG_LIMITS_FIELD_GAP_US_MASK 0xE0000000u

/* What period_cycles takes */
#define ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_MIN 2u
#define ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_MAX 2047u

/* What period_cycles takes on a T-format channel */
#define ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_T_FORMAT_MIN 8u
#define ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_T_FORMAT_MAX 127u

/* What period_cycles takes on an SSI channel */
#define ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_SSI_MIN 4u
#define ENDAT_MAP_CONFIG_FRAME_PERIOD_CYCLES_SSI_MAX 2047u

/* What position_bits takes */
#define ENDAT_MAP_CONFIG_FRAME_POSITION_BITS_MIN 1u
#define ENDAT_MAP_CONFIG_FRAME_POSITION_BITS_MAX 48u

/* What position_bits takes on a T-format channel */
#define ENDAT_MAP_CONFIG_FRAME_POSITION_BITS_T_FORMAT_MIN 1u
#define ENDAT_MAP_CONFIG_FRAME_POSITION_BITS_T_FORMAT_MAX 48u

/* What position_bits takes on an SSI channel */
#define ENDAT_MAP_CONFIG_FRAME_POSITION_BITS_SSI_MIN 1u
#define ENDAT_MAP_CONFIG_FRAME_POSITION_BITS_SSI_MAX 48u

/* What multi_turn_bits takes on a T-format channel */
#define ENDAT_MAP_CONFIG_TIMING_MULTI_TURN_BITS_T_FORMAT_MIN 0u
#define ENDAT_MAP_CONFIG_TIMING_MULTI_TURN_BITS_T_FORMAT_MAX 24u

/* What start_timeout_us takes on a T-format channel */
#define ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US_T_FORMAT_MIN 1u
#define ENDAT_MAP_CONFIG_LIMITS_START_TIMEOUT_US_T_FORMAT_MAX 63u

/* ---- result ---------------------------------------------------------------- */

/* Result of a channel; all words of all channels change together and never within a read command. */
#define ENDAT_MAP_RESULT_BASE_WORD 0x180u
#define ENDAT_MAP_RESULT_BASE_BYTE 0x0600u
#define ENDAT_MAP_RESULT_STRIDE_WORDS 8u
#define ENDAT_MAP_RESULT_STRIDE_BYTES 32u

/* ro: Outcome of the last trigger. */
#define ENDAT_MAP_RESULT_STATUS_WORD(channel) (0x180u + 8u * (channel))
#define ENDAT_MAP_RESULT_STATUS_BYTE(channel) (0x0600u + 32u * (channel))
/* sequence: Number of results, wrapping */
#define ENDAT_MAP_RESULT_STATUS_SEQUENCE_SHIFT 0u
#define ENDAT_MAP_RESULT_STATUS_SEQUENCE_MASK 0x0000FFFFu
/* cause: Primary cause. With some causes the position is good: then fresh is 1 */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SHIFT 16u
#define ENDAT_MAP_RESULT_STATUS_CAUSE_MASK 0x001F0000u
#define ENDAT_MAP_RESULT_STATUS_CAUSE_NONE 0u /* none */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_DATA_NOT_LOW 1u /* data not low before start */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_NO_START_BIT 2u /* no start bit */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_START_WINDOW 3u /* start bit outside its window */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_CRC 4u /* CRC */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_F1 5u /* F1 */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_F2 6u /* F2 */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_DATA_NOT_FALLING 7u /* data not falling after the frame */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_TRIGGER_OVERRUN 8u /* trigger overrun */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_UNKNOWN_COMMAND 9u /* unknown mode command */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_INFO_MISSING 10u /* additional data missing */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_NO_ENCODER 11u /* no encoder */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_STUCK_HIGH 12u /* data stuck high */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_STUCK_LOW 13u /* data stuck low */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_LATE_START 14u /* late start bit */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_WATCHDOG 15u /* watchdog */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_OWN_ECHO 16u /* echo of the own command */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_RECOVERY_TOO_SHORT 17u /* recovery time too short */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_UPSET 31u /* stored data upset */
/* cause: on a T-format channel */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_NONE 0u /* none */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_UNKNOWN_COMMAND 1u /* unknown request */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_LINE_NOT_IDLE 2u /* line not idle */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_NO_ANSWER 3u /* no answer */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_NO_HEADER 4u /* no header */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_CONTROL_PARITY 5u /* parity of the control field */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_REPLY_ECHO 6u /* another ID or address in the reply */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_DELIMITER 7u /* delimiter */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_FIELD_MISSING 8u /* field missing */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_REPLY_CRC 9u /* CRC */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_REQUEST_PARITY 10u /* encoder saw a parity error */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_REQUEST_DELIMITER 11u /* encoder saw a delimiter error */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_EEPROM_BUSY 12u /* EEPROM busy */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_COUNTING_ERROR 13u /* counting error */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_MULTI_TURN_ALARM 14u /* multi-turn or battery alarm */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_UPSET 15u /* stored data upset */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_T_FORMAT_TRIGGER_OVERRUN 16u /* trigger overrun */
/* cause: on an SSI channel */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_NONE 0u /* none */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_UNKNOWN_FRAME 1u /* unknown kind of frame */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_DATA_NOT_HIGH 2u /* data not high before the frame */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_DATA_NOT_LOW_AFTER 3u /* data not low after the last bit */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_POSITION_PARITY 4u /* parity of the position */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_COPIES_DIFFER 5u /* the two copies differ */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_UPSET 6u /* stored data upset */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_TRIGGER_OVERRUN 7u /* trigger overrun */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_RECOVERY_TOO_LONG 8u /* recovery time too long */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_ENCODER_ALARM 9u /* alarm of the encoder */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_POWER_FAIL 10u /* power failure of the encoder */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_POSITION_NOT_VALID 11u /* the encoder marks the position not valid */
#define ENDAT_MAP_RESULT_STATUS_CAUSE_SSI_POSITION_CRC 12u /* CRC of the position */
/* valid: A good position is available */
#define ENDAT_MAP_RESULT_STATUS_VALID_SHIFT 22u
#define ENDAT_MAP_RESULT_STATUS_VALID_MASK 0x00400000u
/* fresh: 1: the last result brought the position; 0: held from an earlier result */
#define ENDAT_MAP_RESULT_STATUS_FRESH_SHIFT 23u
#define ENDAT_MAP_RESULT_STATUS_FRESH_MASK 0x00800000u
/* line: Raw flags that do not fit into evidence */
#define ENDAT_MAP_RESULT_STATUS_LINE_SHIFT 24u
#define ENDAT_MAP_RESULT_STATUS_LINE_MASK 0xFF000000u
#define ENDAT_MAP_RESULT_STATUS_LINE_NO_ENCODER 0x1u /* no encoder */
#define ENDAT_MAP_RESULT_STATUS_LINE_STUCK_HIGH 0x2u /* data stuck high */
#define ENDAT_MAP_RESULT_STATUS_LINE_STUCK_LOW 0x4u /* data stuck low */
#define ENDAT_MAP_RESULT_STATUS_LINE_LATE_START 0x8u /* late start bit */
#define ENDAT_MAP_RESULT_STATUS_LINE_WATCHDOG 0x10u /* watchdog */
#define ENDAT_MAP_RESULT_STATUS_LINE_OWN_ECHO 0x20u /* echo of the own command */
#define ENDAT_MAP_RESULT_STATUS_LINE_RECOVERY_TOO_SHORT 0x40u /* recovery time too short */
#define ENDAT_MAP_RESULT_STATUS_LINE_UPSET 0x80u /* stored data upset */
/* line: on a T-format channel */
#define ENDAT_MAP_RESULT_STATUS_LINE_T_FORMAT_COUNTING_ERROR 0x1u /* counting error */
#define ENDAT_MAP_RESULT_STATUS_LINE_T_FORMAT_MULTI_TURN_ALARM 0x2u /* multi-turn or battery alarm */
#define ENDAT_MAP_RESULT_STATUS_LINE_T_FORMAT_UPSET 0x4u /* stored data upset */
#define ENDAT_MAP_RESULT_STATUS_LINE_T_FORMAT_TRIGGER_OVERRUN 0x8u /* trigger overrun */
/* line: on an SSI channel */
#define ENDAT_MAP_RESULT_STATUS_LINE_SSI_SPECIAL_0 0x1u /* last special bit of the frame */
#define ENDAT_MAP_RESULT_STATUS_LINE_SSI_SPECIAL_1 0x2u /* special bit before it */
#define ENDAT_MAP_RESULT_STATUS_LINE_SSI_SPECIAL_2 0x4u /* special bit 2 before special_0 */
#define ENDAT_MAP_RESULT_STATUS_LINE_SSI_SPECIAL_3 0x8u /* special bit 3 before special_0 */
#define ENDAT_MAP_RESULT_STATUS_LINE_SSI_SPECIAL_4 0x10u /* special bit 4 before special_0 */
#define ENDAT_MAP_RESULT_STATUS_LINE_SSI_SPECIAL_5 0x20u /* special bit 5 before special_0 */
#define ENDAT_MAP_RESULT_STATUS_LINE_SSI_SPECIAL_6 0x40u /* special bit 6 before special_0 */
#define ENDAT_MAP_RESULT_STATUS_LINE_SSI_SPECIAL_7 0x80u /* special bit 7 before special_0 */

/* ro: Last good position, bits 31..0. */
#define ENDAT_MAP_RESULT_POSITION_LOW_WORD(channel) (0x181u + 8u * (channel))
#define ENDAT_MAP_RESULT_POSITION_LOW_BYTE(channel) (0x0604u + 32u * (channel))
/* value: Bit 0 is the LSB */
#define ENDAT_MAP_RESULT_POSITION_LOW_VALUE_SHIFT 0u
#define ENDAT_MAP_RESULT_POSITION_LOW_VALUE_MASK 0xFFFFFFFFu

/* ro: Last good position, bits 47..32. */
#define ENDAT_MAP_RESULT_POSITION_HIGH_WORD(channel) (0x182u + 8u * (channel))
#define ENDAT_MAP_RESULT_POSITION_HIGH_BYTE(channel) (0x0608u + 32u * (channel))
/* value: 0 above the position's width; T-format: multi-turn in bits 47..24, single-turn in 23..0 */
#define ENDAT_MAP_RESULT_POSITION_HIGH_VALUE_SHIFT 0u
#define ENDAT_MAP_RESULT_POSITION_HIGH_VALUE_MASK 0x0000FFFFu
/* crc: CRC received with this position, over F1, F2 and the position, LSB first, for a check by the host; T-format: 0 */
#define ENDAT_MAP_RESULT_POSITION_HIGH_CRC_SHIFT 16u
#define ENDAT_MAP_RESULT_POSITION_HIGH_CRC_MASK 0x001F0000u
/* f2: The position came with F2 = 1 (EnDat 2.2); F1 of a good position is 0 */
#define ENDAT_MAP_RESULT_POSITION_HIGH_F2_SHIFT 22u
#define ENDAT_MAP_RESULT_POSITION_HIGH_F2_MASK 0x00400000u
/* width: Width of this position; 0 = no position yet, or T-format: no check (bits) */
#define ENDAT_MAP_RESULT_POSITION_HIGH_WIDTH_SHIFT 24u
#define ENDAT_MAP_RESULT_POSITION_HIGH_WIDTH_MASK 0x3F000000u

/* ro: First falling clock edge of the frame that brought the position; equal in two EnDat channels: same trigger. T-format: start bit of the request. */
#define ENDAT_MAP_RESULT_TIMESTAMP_WORD(channel) (0x183u + 8u * (channel))
#define ENDAT_MAP_RESULT_TIMESTAMP_BYTE(channel) (0x060Cu + 32u * (channel))
/* value: Since reset, wrapping (cycles) */
#define ENDAT_MAP_RESULT_TIMESTAMP_VALUE_SHIFT 0u
#define ENDAT_MAP_RESULT_TIMESTAMP_VALUE_MASK 0xFFFFFFFFu

/* ro: Quality of the last frame. */
#define ENDAT_MAP_RESULT_EVIDENCE_WORD(channel) (0x184u + 8u * (channel))
#define ENDAT_MAP_RESULT_EVIDENCE_BYTE(channel) (0x0610u + 32u * (channel))
/* crc_received: CRC as received */
#define ENDAT_MAP_RESULT_EVIDENCE_CRC_RECEIVED_SHIFT 0u
#define ENDAT_MAP_RESULT_EVIDENCE_CRC_RECEIVED_MASK 0x0000001Fu
/* crc_computed: CRC as computed */
#define ENDAT_MAP_RESULT_EVIDENCE_CRC_COMPUTED_SHIFT 5u
#define ENDAT_MAP_RESULT_EVIDENCE_CRC_COMPUTED_MASK 0x000003E0u
/* delay_cycles: Tracked line delay tD, including synchroniser and filter (cycles) */
#define ENDAT_MAP_RESULT_EVIDENCE_DELAY_CYCLES_SHIFT 10u
#define ENDAT_MAP_RESULT_EVIDENCE_DELAY_CYCLES_MASK 0x000FFC00u
/* flags: Raw flags; status.line has the others */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SHIFT 20u
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_MASK 0xFFF00000u
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_DATA_NOT_LOW 0x1u /* data not low before start */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_NO_START_BIT 0x2u /* no start bit */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_START_WINDOW 0x4u /* start bit outside its window */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_CRC 0x8u /* CRC */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_F1 0x10u /* F1 */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_F2 0x20u /* F2 */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_DATA_NOT_FALLING 0x40u /* data not falling after the frame */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_TRIGGER_OVERRUN 0x80u /* trigger overrun */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_PARALLEL_CRC 0x100u /* parallel CRC */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_TAIL_LOW 0x200u /* data not high after the frame */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_UNKNOWN_COMMAND 0x400u /* unknown mode command */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_INFO_MISSING 0x800u /* additional data missing */
/* flags: on a T-format channel */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_UNKNOWN_COMMAND 0x1u /* unknown request */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_LINE_NOT_IDLE 0x2u /* line not idle */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_NO_ANSWER 0x4u /* no answer */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_NO_HEADER 0x8u /* no header */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_CONTROL_PARITY 0x10u /* parity of the control field */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_REPLY_ECHO 0x20u /* another ID or address in the reply */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_DELIMITER 0x40u /* delimiter */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_FIELD_MISSING 0x80u /* field missing */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_REPLY_CRC 0x100u /* CRC */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_REQUEST_PARITY 0x200u /* encoder saw a parity error */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_REQUEST_DELIMITER 0x400u /* encoder saw a delimiter error */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_T_FORMAT_EEPROM_BUSY 0x800u /* EEPROM busy */
/* flags: on an SSI channel */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_UNKNOWN_FRAME 0x1u /* unknown kind of frame */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_DATA_NOT_HIGH 0x2u /* data not high before the frame */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_DATA_NOT_LOW_AFTER 0x4u /* data not low after the last bit */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_POSITION_PARITY 0x8u /* parity of the position */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_COPIES_DIFFER 0x10u /* the two copies differ */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_UPSET 0x20u /* stored data upset */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_TRIGGER_OVERRUN 0x40u /* trigger overrun */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_RECOVERY_TOO_LONG 0x80u /* recovery time too long */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_ENCODER_ALARM 0x100u /* alarm of the encoder */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_POWER_FAIL 0x200u /* power failure of the encoder */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_POSITION_NOT_VALID 0x400u /* the encoder marks the position not valid */
#define ENDAT_MAP_RESULT_EVIDENCE_FLAGS_SSI_POSITION_CRC 0x800u /* CRC of the position */

/* ro: Age and recovery time. */
#define ENDAT_MAP_RESULT_AGE_RECOVERY_WORD(channel) (0x185u + 8u * (channel))
#define ENDAT_MAP_RESULT_AGE_RECOVERY_BYTE(channel) (0x0614u + 32u * (channel))
/* age_us: Age of the position, counted from the end of its frame (0 until then), also while results are held; stops at 65535 (us) */
#define ENDAT_MAP_RESULT_AGE_RECOVERY_AGE_US_SHIFT 0u
#define ENDAT_MAP_RESULT_AGE_RECOVERY_AGE_US_MASK 0x0000FFFFu
/* recovery_cycles: Recovery time tm of the last frame (cycles) */
#define ENDAT_MAP_RESULT_AGE_RECOVERY_RECOVERY_CYCLES_SHIFT 16u
#define ENDAT_MAP_RESULT_AGE_RECOVERY_RECOVERY_CYCLES_MASK 0x1FFF0000u
/* delay_high: Bit 10 of delay_cycles */
#define ENDAT_MAP_RESULT_AGE_RECOVERY_DELAY_HIGH_SHIFT 29u
#define ENDAT_MAP_RESULT_AGE_RECOVERY_DELAY_HIGH_MASK 0x20000000u
/* stale: The channel has had a trigger since this result */
#define ENDAT_MAP_RESULT_AGE_RECOVERY_STALE_SHIFT 30u
#define ENDAT_MAP_RESULT_AGE_RECOVERY_STALE_MASK 0x40000000u

/* ro: Additional data 1 of the frame of this result. */
#define ENDAT_MAP_RESULT_INFO_1_WORD(channel) (0x186u + 8u * (channel))
#define ENDAT_MAP_RESULT_INFO_1_BYTE(channel) (0x0618u + 32u * (channel))
/* content: Content; 0 unless good */
#define ENDAT_MAP_RESULT_INFO_1_CONTENT_SHIFT 0u
#define ENDAT_MAP_RESULT_INFO_1_CONTENT_MASK 0x0000FFFFu
/* sign: I4..I0: number of the content; I4 = 0 additional data 1, 1 additional data 2 */
#define ENDAT_MAP_RESULT_INFO_1_SIGN_SHIFT 16u
#define ENDAT_MAP_RESULT_INFO_1_SIGN_MASK 0x001F0000u
/* busy: The encoder is busy with a request */
#define ENDAT_MAP_RESULT_INFO_1_BUSY_SHIFT 21u
#define ENDAT_MAP_RESULT_INFO_1_BUSY_MASK 0x00200000u
/* reference_mark: RM: the reference mark has been passed */
#define ENDAT_MAP_RESULT_INFO_1_REFERENCE_MARK_SHIFT 22u
#define ENDAT_MAP_RESULT_INFO_1_REFERENCE_MARK_MASK 0x00400000u
/* warning: WRN: a warning of the encoder is set */
#define ENDAT_MAP_RESULT_INFO_1_WARNING_SHIFT 23u
#define ENDAT_MAP_RESULT_INFO_1_WARNING_MASK 0x00800000u
/* came: The frame included this block */
#define ENDAT_MAP_RESULT_INFO_1_CAME_SHIFT 24u
#define ENDAT_MAP_RESULT_INFO_1_CAME_MASK 0x01000000u
/* good: The CRC is right */
#define ENDAT_MAP_RESULT_INFO_1_GOOD_SHIFT 25u
#define ENDAT_MAP_RESULT_INFO_1_GOOD_MASK 0x02000000u
/* crc: CRC as received, over bits 23..0 as received */
#define ENDAT_MAP_RESULT_INFO_1_CRC_SHIFT 26u
#define ENDAT_MAP_RESULT_INFO_1_CRC_MASK 0x7C000000u

/* ro: Additional data 2 of the frame of this result. */
#define ENDAT_MAP_RESULT_INFO_2_WORD(channel) (0x187u + 8u * (channel))
#define ENDAT_MAP_RESULT_INFO_2_BYTE(channel) (0x061Cu + 32u * (channel))
/* content: Content; 0 unless good */
#define ENDAT_MAP_RESULT_INFO_2_CONTENT_SHIFT 0u
#define ENDAT_MAP_RESULT_INFO_2_CONTENT_MASK 0x0000FFFFu
/* sign: I4..I0: number of the content; I4 = 0 additional data 1, 1 additional data 2 */
#define ENDAT_MAP_RESULT_INFO_2_SIGN_SHIFT 16u
#define ENDAT_MAP_RESULT_INFO_2_SIGN_MASK 0x001F0000u
/* busy: The encoder is busy with a request */
#define ENDAT_MAP_RESULT_INFO_2_BUSY_SHIFT 21u
#define ENDAT_MAP_RESULT_INFO_2_BUSY_MASK 0x00200000u
/* reference_mark: RM: the reference mark has been passed */
#define ENDAT_MAP_RESULT_INFO_2_REFERENCE_MARK_SHIFT 22u
#define ENDAT_MAP_RESULT_INFO_2_REFERENCE_MARK_MASK 0x00400000u
/* warning: WRN: a warning of the encoder is set */
#define ENDAT_MAP_RESULT_INFO_2_WARNING_SHIFT 23u
#define ENDAT_MAP_RESULT_INFO_2_WARNING_MASK 0x00800000u
/* came: The frame included this block */
#define ENDAT_MAP_RESULT_INFO_2_CAME_SHIFT 24u
#define ENDAT_MAP_RESULT_INFO_2_CAME_MASK 0x01000000u
/* good: The CRC is right */
#define ENDAT_MAP_RESULT_INFO_2_GOOD_SHIFT 25u
#define ENDAT_MAP_RESULT_INFO_2_GOOD_MASK 0x02000000u
/* crc: CRC as received, over bits 23..0 as received */
#define ENDAT_MAP_RESULT_INFO_2_CRC_SHIFT 26u
#define ENDAT_MAP_RESULT_INFO_2_CRC_MASK 0x7C000000u

/* ---- line ------------------------------------------------------------------ */

/* Sampling phase and timing margin. A place is a system clock cycle, or half of one with double_edge; offsets are signed. */
#define ENDAT_MAP_LINE_BASE_WORD 0x200u
#define ENDAT_MAP_LINE_BASE_BYTE 0x0800u
#define ENDAT_MAP_LINE_STRIDE_WORDS 64u
#define ENDAT_MAP_LINE_STRIDE_BYTES 256u

/* ro: Edges with offset -16 or less (all bins: offset divided by 2^bin_shift). */
#define ENDAT_MAP_LINE_EDGES_0_WORD(channel) (0x200u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_0_BYTE(channel) (0x0800u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_0_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_0_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -15. */
#define ENDAT_MAP_LINE_EDGES_1_WORD(channel) (0x201u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_1_BYTE(channel) (0x0804u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_1_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_1_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -14. */
#define ENDAT_MAP_LINE_EDGES_2_WORD(channel) (0x202u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_2_BYTE(channel) (0x0808u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_2_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_2_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -13. */
#define ENDAT_MAP_LINE_EDGES_3_WORD(channel) (0x203u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_3_BYTE(channel) (0x080Cu + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_3_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_3_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -12. */
#define ENDAT_MAP_LINE_EDGES_4_WORD(channel) (0x204u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_4_BYTE(channel) (0x0810u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_4_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_4_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -11. */
#define ENDAT_MAP_LINE_EDGES_5_WORD(channel) (0x205u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_5_BYTE(channel) (0x0814u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_5_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_5_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -10. */
#define ENDAT_MAP_LINE_EDGES_6_WORD(channel) (0x206u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_6_BYTE(channel) (0x0818u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_6_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_6_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -9. */
#define ENDAT_MAP_LINE_EDGES_7_WORD(channel) (0x207u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_7_BYTE(channel) (0x081Cu + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_7_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_7_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -8. */
#define ENDAT_MAP_LINE_EDGES_8_WORD(channel) (0x208u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_8_BYTE(channel) (0x0820u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_8_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_8_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -7. */
#define ENDAT_MAP_LINE_EDGES_9_WORD(channel) (0x209u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_9_BYTE(channel) (0x0824u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_9_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_9_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -6. */
#define ENDAT_MAP_LINE_EDGES_10_WORD(channel) (0x20Au + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_10_BYTE(channel) (0x0828u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_10_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_10_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -5. */
#define ENDAT_MAP_LINE_EDGES_11_WORD(channel) (0x20Bu + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_11_BYTE(channel) (0x082Cu + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_11_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_11_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -4. */
#define ENDAT_MAP_LINE_EDGES_12_WORD(channel) (0x20Cu + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_12_BYTE(channel) (0x0830u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_12_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_12_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -3. */
#define ENDAT_MAP_LINE_EDGES_13_WORD(channel) (0x20Du + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_13_BYTE(channel) (0x0834u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_13_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_13_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -2. */
#define ENDAT_MAP_LINE_EDGES_14_WORD(channel) (0x20Eu + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_14_BYTE(channel) (0x0838u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_14_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_14_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset -1: at the expected place, or up to one place before. */
#define ENDAT_MAP_LINE_EDGES_15_WORD(channel) (0x20Fu + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_15_BYTE(channel) (0x083Cu + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_15_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_15_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 0: up to one place after the expected one. */
#define ENDAT_MAP_LINE_EDGES_16_WORD(channel) (0x210u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_16_BYTE(channel) (0x0840u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_16_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_16_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 1. */
#define ENDAT_MAP_LINE_EDGES_17_WORD(channel) (0x211u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_17_BYTE(channel) (0x0844u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_17_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_17_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 2. */
#define ENDAT_MAP_LINE_EDGES_18_WORD(channel) (0x212u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_18_BYTE(channel) (0x0848u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_18_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_18_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 3. */
#define ENDAT_MAP_LINE_EDGES_19_WORD(channel) (0x213u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_19_BYTE(channel) (0x084Cu + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_19_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_19_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 4. */
#define ENDAT_MAP_LINE_EDGES_20_WORD(channel) (0x214u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_20_BYTE(channel) (0x0850u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_20_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_20_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 5. */
#define ENDAT_MAP_LINE_EDGES_21_WORD(channel) (0x215u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_21_BYTE(channel) (0x0854u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_21_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_21_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 6. */
#define ENDAT_MAP_LINE_EDGES_22_WORD(channel) (0x216u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_22_BYTE(channel) (0x0858u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_22_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_22_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 7. */
#define ENDAT_MAP_LINE_EDGES_23_WORD(channel) (0x217u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_23_BYTE(channel) (0x085Cu + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_23_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_23_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 8. */
#define ENDAT_MAP_LINE_EDGES_24_WORD(channel) (0x218u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_24_BYTE(channel) (0x0860u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_24_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_24_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 9. */
#define ENDAT_MAP_LINE_EDGES_25_WORD(channel) (0x219u + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_25_BYTE(channel) (0x0864u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_25_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_25_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 10. */
#define ENDAT_MAP_LINE_EDGES_26_WORD(channel) (0x21Au + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_26_BYTE(channel) (0x0868u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_26_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_26_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 11. */
#define ENDAT_MAP_LINE_EDGES_27_WORD(channel) (0x21Bu + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_27_BYTE(channel) (0x086Cu + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_27_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_27_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 12. */
#define ENDAT_MAP_LINE_EDGES_28_WORD(channel) (0x21Cu + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_28_BYTE(channel) (0x0870u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_28_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_28_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 13. */
#define ENDAT_MAP_LINE_EDGES_29_WORD(channel) (0x21Du + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_29_BYTE(channel) (0x0874u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_29_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_29_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 14. */
#define ENDAT_MAP_LINE_EDGES_30_WORD(channel) (0x21Eu + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_30_BYTE(channel) (0x0878u + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_30_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_30_EDGES_MASK 0xFFFFFFFFu

/* ro: Edges with offset 15 or more. */
#define ENDAT_MAP_LINE_EDGES_31_WORD(channel) (0x21Fu + 64u * (channel))
#define ENDAT_MAP_LINE_EDGES_31_BYTE(channel) (0x087Cu + 256u * (channel))
/* edges: Edges since clear, wrapping */
#define ENDAT_MAP_LINE_EDGES_31_EDGES_SHIFT 0u
#define ENDAT_MAP_LINE_EDGES_31_EDGES_MASK 0xFFFFFFFFu

/* rw: Source of the phase; takes effect between two frames. */
#define ENDAT_MAP_LINE_ALIGNMENT_WORD(channel) (0x220u + 64u * (channel))
#define ENDAT_MAP_LINE_ALIGNMENT_BYTE(channel) (0x0880u + 256u * (channel))
/* mode: Source of the sampling phase */
#define ENDAT_MAP_LINE_ALIGNMENT_MODE_SHIFT 0u
#define ENDAT_MAP_LINE_ALIGNMENT_MODE_MASK 0x00000003u
#define ENDAT_MAP_LINE_ALIGNMENT_MODE_TRACKED 0u /* mean of many edges */
#define ENDAT_MAP_LINE_ALIGNMENT_MODE_FIXED 1u /* fixed_delay */
#define ENDAT_MAP_LINE_ALIGNMENT_MODE_FRAME 2u /* start bit of each frame */
/* majority: Each sample is the majority of itself and its two neighbours; measure the delay again after a change */
#define ENDAT_MAP_LINE_ALIGNMENT_MAJORITY_SHIFT 4u
#define ENDAT_MAP_LINE_ALIGNMENT_MAJORITY_MASK 0x00000010u
/* bin_shift: Bins of the histogram are 2^bin_shift places wide; clear after a change */
#define ENDAT_MAP_LINE_ALIGNMENT_BIN_SHIFT_SHIFT 8u
#define ENDAT_MAP_LINE_ALIGNMENT_BIN_SHIFT_MASK 0x00000300u

/* rw: Delay in mode fixed, including synchroniser and filter. */
#define ENDAT_MAP_LINE_FIXED_DELAY_WORD(channel) (0x221u + 64u * (channel))
#define ENDAT_MAP_LINE_FIXED_DELAY_BYTE(channel) (0x0884u + 256u * (channel))
/* value: In the format of phase.tracked (cycles/16) */
#define ENDAT_MAP_LINE_FIXED_DELAY_VALUE_SHIFT 0u
#define ENDAT_MAP_LINE_FIXED_DELAY_VALUE_MASK 0x00007FFFu

/* rw: Limits of the alarms; 0 = none. */
#define ENDAT_MAP_LINE_LIMITS_WORD(channel) (0x222u + 64u * (channel))
#define ENDAT_MAP_LINE_LIMITS_BYTE(channel) (0x0888u + 256u * (channel))
/* drift: Largest allowed distance of the tracked delay from its reference (cycles/16) */
#define ENDAT_MAP_LINE_LIMITS_DRIFT_SHIFT 0u
#define ENDAT_MAP_LINE_LIMITS_DRIFT_MASK 0x00000FFFu
/* offset: Largest allowed offset of an edge (places) */
#define ENDAT_MAP_LINE_LIMITS_OFFSET_SHIFT 16u
#define ENDAT_MAP_LINE_LIMITS_OFFSET_MASK 0x007F0000u

/* strobe: Clears the monitor, or sets the reference. */
#define ENDAT_MAP_LINE_CLEAR_WORD(channel) (0x223u + 64u * (channel))
#define ENDAT_MAP_LINE_CLEAR_BYTE(channel) (0x088Cu + 256u * (channel))
/* clear: Write 1: histogram, worst edges, alarms, counters */
#define ENDAT_MAP_LINE_CLEAR_CLEAR_SHIFT 0u
#define ENDAT_MAP_LINE_CLEAR_CLEAR_MASK 0x00000001u
/* reference: Write 1: the tracked delay becomes the reference */
#define ENDAT_MAP_LINE_CLEAR_REFERENCE_SHIFT 1u
#define ENDAT_MAP_LINE_CLEAR_REFERENCE_MASK 0x00000002u

/* ro: Edges of the last frame. */
#define ENDAT_MAP_LINE_FRAME_WORD(channel) (0x228u + 64u * (channel))
#define ENDAT_MAP_LINE_FRAME_BYTE(channel) (0x08A0u + 256u * (channel))
/* earliest: Smallest offset (places) */
#define ENDAT_MAP_LINE_FRAME_EARLIEST_SHIFT 0u
#define ENDAT_MAP_LINE_FRAME_EARLIEST_MASK 0x000000FFu
/* latest: Largest offset (places) */
#define ENDAT_MAP_LINE_FRAME_LATEST_SHIFT 8u
#define ENDAT_MAP_LINE_FRAME_LATEST_MASK 0x0000FF00u
/* start: Offset of the start bit's edge (places) */
#define ENDAT_MAP_LINE_FRAME_START_SHIFT 16u
#define ENDAT_MAP_LINE_FRAME_START_MASK 0x00FF0000u

/* ro: Extreme edges since clear. */
#define ENDAT_MAP_LINE_WORST_WORD(channel) (0x229u + 64u * (channel))
#define ENDAT_MAP_LINE_WORST_BYTE(channel) (0x08A4u + 256u * (channel))
/* earliest: Smallest offset (places) */
#define ENDAT_MAP_LINE_WORST_EARLIEST_SHIFT 0u
#define ENDAT_MAP_LINE_WORST_EARLIEST_MASK 0x000000FFu
/* latest: Largest offset (places) */
#define ENDAT_MAP_LINE_WORST_LATEST_SHIFT 8u
#define ENDAT_MAP_LINE_WORST_LATEST_MASK 0x0000FF00u
/* valid: At least one edge was measured */
#define ENDAT_MAP_LINE_WORST_VALID_SHIFT 16u
#define ENDAT_MAP_LINE_WORST_VALID_MASK 0x00010000u
/* drift_alarm: The drift exceeded its limit */
#define ENDAT_MAP_LINE_WORST_DRIFT_ALARM_SHIFT 24u
#define ENDAT_MAP_LINE_WORST_DRIFT_ALARM_MASK 0x01000000u
/* offset_alarm: An edge exceeded its limit */
#define ENDAT_MAP_LINE_WORST_OFFSET_ALARM_SHIFT 25u
#define ENDAT_MAP_LINE_WORST_OFFSET_ALARM_MASK 0x02000000u

/* ro: Tracked delay, including synchroniser and filter. */
#define ENDAT_MAP_LINE_PHASE_WORD(channel) (0x22Au + 64u * (channel))
#define ENDAT_MAP_LINE_PHASE_BYTE(channel) (0x08A8u + 256u * (channel))
/* tracked: Mean place of the edges after their clock edge (cycles/16) */
#define ENDAT_MAP_LINE_PHASE_TRACKED_SHIFT 0u
#define ENDAT_MAP_LINE_PHASE_TRACKED_MASK 0x00007FFFu
/* reference: Tracked delay when it was measured or last set as reference (cycles/16) */
#define ENDAT_MAP_LINE_PHASE_REFERENCE_SHIFT 16u
#define ENDAT_MAP_LINE_PHASE_REFERENCE_MASK 0x7FFF0000u

/* ro: Counters, wrapping. */
#define ENDAT_MAP_LINE_COUNTS_WORD(channel) (0x22Bu + 64u * (channel))
#define ENDAT_MAP_LINE_COUNTS_BYTE(channel) (0x08ACu + 256u * (channel))
/* glitches: Pulses removed by the input filter since clear */
#define ENDAT_MAP_LINE_COUNTS_GLITCHES_SHIFT 0u
#define ENDAT_MAP_LINE_COUNTS_GLITCHES_MASK 0x0000FFFFu
/* bad_frames: Frames with a cause other than 0 since clear */
#define ENDAT_MAP_LINE_COUNTS_BAD_FRAMES_SHIFT 16u
#define ENDAT_MAP_LINE_COUNTS_BAD_FRAMES_MASK 0xFFFF0000u

/* ro: Frames since clear, wrapping. */
#define ENDAT_MAP_LINE_FRAMES_WORD(channel) (0x22Cu + 64u * (channel))
#define ENDAT_MAP_LINE_FRAMES_BYTE(channel) (0x08B0u + 256u * (channel))
/* value: Frames */
#define ENDAT_MAP_LINE_FRAMES_VALUE_SHIFT 0u
#define ENDAT_MAP_LINE_FRAMES_VALUE_MASK 0xFFFFFFFFu

/* ---- service --------------------------------------------------------------- */

/* Requests, health, slots and name plate of a channel. RAM: 0 after power-up, a reset does not clear it. */
#define ENDAT_MAP_SERVICE_BASE_WORD 0x400u
#define ENDAT_MAP_SERVICE_BASE_BYTE 0x1000u
#define ENDAT_MAP_SERVICE_STRIDE_WORDS 128u
#define ENDAT_MAP_SERVICE_STRIDE_BYTES 512u

/* rw: Sends a request when written. */
#define ENDAT_MAP_SERVICE_REQUEST_WORD(channel) (0x400u + 128u * (channel))
#define ENDAT_MAP_SERVICE_REQUEST_BYTE(channel) (0x1000u + 512u * (channel))
/* data: Data */
#define ENDAT_MAP_SERVICE_REQUEST_DATA_SHIFT 0u
#define ENDAT_MAP_SERVICE_REQUEST_DATA_MASK 0x0000FFFFu
/* address: MRS code, address or port */
#define ENDAT_MAP_SERVICE_REQUEST_ADDRESS_SHIFT 16u
#define ENDAT_MAP_SERVICE_REQUEST_ADDRESS_MASK 0x00FF0000u
/* command: Mode command, any of the fourteen */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_SHIFT 24u
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_MASK 0x3F000000u
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_SEND_POSITION 7u /* 000111 send position (EnDat 2.1) */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_SELECT_MEMORY 14u /* 001110 selection of memory area */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_RECEIVE_PARAMETER 28u /* 011100 receive parameter */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_SEND_PARAMETER 35u /* 100011 send parameter */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_RECEIVE_RESET 42u /* 101010 receive reset */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_SEND_TEST_VALUES 21u /* 010101 send test values */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_RECEIVE_TEST_COMMAND 49u /* 110001 receive test command */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_SEND_POSITION_ADD_INFO 56u /* 111000 send position with additional data (EnDat 2.2) */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_POSITION_SELECT_MEMORY 9u /* 001001 send position, then selection of memory area or additional data */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_POSITION_RECEIVE_PARAMETER 27u /* 011011 send position, then receive parameter */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_POSITION_SEND_PARAMETER 36u /* 100100 send position, then send parameter */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_POSITION_ERROR_RESET 45u /* 101101 send position, then receive error reset */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_POSITION_TEST_COMMAND 54u /* 110110 send position, then receive test command */
#define ENDAT_MAP_SERVICE_REQUEST_COMMAND_RECEIVE_COMMUNICATION 18u /* 010010 receive communication command */

/* ro: State of the request. */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_WORD(channel) (0x401u + 128u * (channel))
#define ENDAT_MAP_SERVICE_REQUEST_STATE_BYTE(channel) (0x1004u + 512u * (channel))
/* busy: The request is under way */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_BUSY_SHIFT 0u
#define ENDAT_MAP_SERVICE_REQUEST_STATE_BUSY_MASK 0x00000001u
/* error: Error of the request */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_SHIFT 4u
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_MASK 0x000000F0u
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_FULFILLED 0u /* fulfilled */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_NO_ANSWER 1u /* no answer: command not understood or refused */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_ADDRESS_ECHO 2u /* echo of MRS code, address or port wrong */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_DATA_ECHO 3u /* echo of data wrong */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_CRC 4u /* CRC of the answer wrong */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_UNKNOWN_COMMAND 5u /* unknown mode command, nothing was sent */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_FRAME 6u /* frame failed or could not begin */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_BUSY_TIMEOUT 7u /* encoder stayed busy */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_NO_TRIGGER 8u /* no trigger came in time for a request that waits for one */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_ERROR_CANCELLED 9u /* cancelled by the host */
/* finished: Requests finished, wrapping */
#define ENDAT_MAP_SERVICE_REQUEST_STATE_FINISHED_SHIFT 16u
#define ENDAT_MAP_SERVICE_REQUEST_STATE_FINISHED_MASK 0xFFFF0000u

/* ro: Answer to the last request; bits 31..0 of a longer one. */
#define ENDAT_MAP_SERVICE_ANSWER_WORD(channel) (0x402u + 128u * (channel))
#define ENDAT_MAP_SERVICE_ANSWER_BYTE(channel) (0x1008u + 512u * (channel))
/* data: Data, or content of additional data 1 */
#define ENDAT_MAP_SERVICE_ANSWER_DATA_SHIFT 0u
#define ENDAT_MAP_SERVICE_ANSWER_DATA_MASK 0x0000FFFFu
/* address: Echo of MRS code, address or port; or WRN, RM, Busy, I4..I0 */
#define ENDAT_MAP_SERVICE_ANSWER_ADDRESS_SHIFT 16u
#define ENDAT_MAP_SERVICE_ANSWER_ADDRESS_MASK 0x00FF0000u

/* ro: Bits 47..32 of a longer answer. */
#define ENDAT_MAP_SERVICE_ANSWER_MORE_WORD(channel) (0x403u + 128u * (channel))
#define ENDAT_MAP_SERVICE_ANSWER_MORE_BYTE(channel) (0x100Cu + 512u * (channel))
/* value: Bits 47..32 */
#define ENDAT_MAP_SERVICE_ANSWER_MORE_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_ANSWER_MORE_VALUE_MASK 0x0000FFFFu

/* ro: Duration of the last request. */
#define ENDAT_MAP_SERVICE_DURATION_WORD(channel) (0x404u + 128u * (channel))
#define ENDAT_MAP_SERVICE_DURATION_BYTE(channel) (0x1010u + 512u * (channel))
/* us: Modulo 65536 (us) */
#define ENDAT_MAP_SERVICE_DURATION_US_SHIFT 0u
#define ENDAT_MAP_SERVICE_DURATION_US_MASK 0x0000FFFFu
/* ms: Milliseconds (ms) */
#define ENDAT_MAP_SERVICE_DURATION_MS_SHIFT 16u
#define ENDAT_MAP_SERVICE_DURATION_MS_MASK 0xFFFF0000u

/* rw: Actions on write. */
#define ENDAT_MAP_SERVICE_CONTROL_WORD(channel) (0x405u + 128u * (channel))
#define ENDAT_MAP_SERVICE_CONTROL_BYTE(channel) (0x1014u + 512u * (channel))
/* initialise: 1: initialise the encoder */
#define ENDAT_MAP_SERVICE_CONTROL_INITIALISE_SHIFT 0u
#define ENDAT_MAP_SERVICE_CONTROL_INITIALISE_MASK 0x00000001u
/* clear: 1: counters, alarm, position_2 and error_test to zero; lost.triggers goes on */
#define ENDAT_MAP_SERVICE_CONTROL_CLEAR_SHIFT 1u
#define ENDAT_MAP_SERVICE_CONTROL_CLEAR_MASK 0x00000002u
/* cancel: 1: cancel the request that waits for a trigger; one on the wire is finished */
#define ENDAT_MAP_SERVICE_CONTROL_CANCEL_SHIFT 2u
#define ENDAT_MAP_SERVICE_CONTROL_CANCEL_MASK 0x00000004u

/* rw: Forced errors in the received data, for tests of the error paths; not for regular operation. */
#define ENDAT_MAP_SERVICE_FORCE_WORD(channel) (0x406u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FORCE_BYTE(channel) (0x1018u + 512u * (channel))
/* f1: Inverts F1 */
#define ENDAT_MAP_SERVICE_FORCE_F1_SHIFT 0u
#define ENDAT_MAP_SERVICE_FORCE_F1_MASK 0x00000001u
/* f2: Inverts F2 */
#define ENDAT_MAP_SERVICE_FORCE_F2_SHIFT 1u
#define ENDAT_MAP_SERVICE_FORCE_F2_MASK 0x00000002u
/* crc: Corrupts the CRC */
#define ENDAT_MAP_SERVICE_FORCE_CRC_SHIFT 2u
#define ENDAT_MAP_SERVICE_FORCE_CRC_MASK 0x00000004u
/* second_receiver: The second receiver disagrees, on cards with one */
#define ENDAT_MAP_SERVICE_FORCE_SECOND_RECEIVER_SHIFT 3u
#define ENDAT_MAP_SERVICE_FORCE_SECOND_RECEIVER_MASK 0x00000008u
/* own_frames: 1: only in the separate frames of requests */
#define ENDAT_MAP_SERVICE_FORCE_OWN_FRAMES_SHIFT 4u
#define ENDAT_MAP_SERVICE_FORCE_OWN_FRAMES_MASK 0x00000010u

/* ro: Initialisation. */
#define ENDAT_MAP_SERVICE_PROGRESS_WORD(channel) (0x407u + 128u * (channel))
#define ENDAT_MAP_SERVICE_PROGRESS_BYTE(channel) (0x101Cu + 512u * (channel))
/* step: Step under way */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_SHIFT 0u
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_MASK 0x0000FFFFu
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_NONE 0u /* none */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_RESET 1u /* reset */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_SELECT_B9 2u /* select memory area 0xB9 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_ALARMS 3u /* read alarms */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_WARNINGS 4u /* read warnings */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_CLEAR_ALARMS 5u /* write 0 to word 0 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_CLEAR_WARNINGS 6u /* write 0 to word 1 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_SELECT_A1 7u /* select memory area 0xA1 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_POSITION_BITS 8u /* read position_bits */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_TAKE_WIDTH 9u /* take over the position width */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_ENCODER_TYPE 10u /* read encoder_type */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_SIGNAL_PERIODS_LOW 11u /* read signal_periods_low */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_SELECT_A3 12u /* select memory area 0xA3 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_SIGNAL_PERIODS_HIGH 13u /* read signal_periods_high */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_REVOLUTIONS 14u /* read revolutions */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_STEPS_LOW 15u /* read steps_low */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_STEPS_HIGH 16u /* read steps_high */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_ID_0 17u /* read id_0 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_ID_1 18u /* read id_1 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_ID_2 19u /* read id_2 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_SERIAL_0 20u /* read serial_0 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_SERIAL_1 21u /* read serial_1 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_SERIAL_2 22u /* read serial_2 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_SELECT_A5 23u /* select memory area 0xA5 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_COMMANDS 24u /* read commands */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_TCAL 25u /* read tcal */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_FIND_ENDAT22 26u /* find out whether it knows EnDat 2.2 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_SELECT_BD 27u /* select memory area 0xBD */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_INFOS_1 28u /* read infos_1 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_INFOS_2 29u /* read infos_2 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_CLOCK_MAX_KHZ 30u /* read clock_max_khz */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_CHOOSE_CLOCK 31u /* choose the clock */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_SELECT_B9_AGAIN 32u /* select memory area 0xB9 */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_READ_RECOVERY 33u /* read recovery */
#define ENDAT_MAP_SERVICE_PROGRESS_STEP_SET_RECOVERY 34u /* set the recovery time */
/* failed: Step that failed */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_SHIFT 16u
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_MASK 0xFFFF0000u
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_NONE 0u /* none */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_RESET 1u /* reset */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_SELECT_B9 2u /* select memory area 0xB9 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_ALARMS 3u /* read alarms */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_WARNINGS 4u /* read warnings */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_CLEAR_ALARMS 5u /* write 0 to word 0 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_CLEAR_WARNINGS 6u /* write 0 to word 1 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_SELECT_A1 7u /* select memory area 0xA1 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_POSITION_BITS 8u /* read position_bits */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_TAKE_WIDTH 9u /* take over the position width */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_ENCODER_TYPE 10u /* read encoder_type */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_SIGNAL_PERIODS_LOW 11u /* read signal_periods_low */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_SELECT_A3 12u /* select memory area 0xA3 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_SIGNAL_PERIODS_HIGH 13u /* read signal_periods_high */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_REVOLUTIONS 14u /* read revolutions */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_STEPS_LOW 15u /* read steps_low */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_STEPS_HIGH 16u /* read steps_high */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_ID_0 17u /* read id_0 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_ID_1 18u /* read id_1 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_ID_2 19u /* read id_2 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_SERIAL_0 20u /* read serial_0 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_SERIAL_1 21u /* read serial_1 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_SERIAL_2 22u /* read serial_2 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_SELECT_A5 23u /* select memory area 0xA5 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_COMMANDS 24u /* read commands */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_TCAL 25u /* read tcal */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_FIND_ENDAT22 26u /* find out whether it knows EnDat 2.2 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_SELECT_BD 27u /* select memory area 0xBD */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_INFOS_1 28u /* read infos_1 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_INFOS_2 29u /* read infos_2 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_CLOCK_MAX_KHZ 30u /* read clock_max_khz */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_CHOOSE_CLOCK 31u /* choose the clock */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_SELECT_B9_AGAIN 32u /* select memory area 0xB9 */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_READ_RECOVERY 33u /* read recovery */
#define ENDAT_MAP_SERVICE_PROGRESS_FAILED_SET_RECOVERY 34u /* set the recovery time */

/* ro: State of the encoder and of its monitoring. */
#define ENDAT_MAP_SERVICE_STATE_WORD(channel) (0x408u + 128u * (channel))
#define ENDAT_MAP_SERVICE_STATE_BYTE(channel) (0x1020u + 512u * (channel))
/* initialised: The name plate is valid */
#define ENDAT_MAP_SERVICE_STATE_INITIALISED_SHIFT 0u
#define ENDAT_MAP_SERVICE_STATE_INITIALISED_MASK 0x00000001u
/* alarm: Too many bad frames; latched */
#define ENDAT_MAP_SERVICE_STATE_ALARM_SHIFT 1u
#define ENDAT_MAP_SERVICE_STATE_ALARM_MASK 0x00000002u
/* position_2: Position 2 was too far from position 1; latched */
#define ENDAT_MAP_SERVICE_STATE_POSITION_2_SHIFT 2u
#define ENDAT_MAP_SERVICE_STATE_POSITION_2_MASK 0x00000004u
/* endat22: The encoder supports EnDat 2.2 */
#define ENDAT_MAP_SERVICE_STATE_ENDAT22_SHIFT 3u
#define ENDAT_MAP_SERVICE_STATE_ENDAT22_MASK 0x00000008u
/* other_width: The encoder has another width than configured, which the card uses */
#define ENDAT_MAP_SERVICE_STATE_OTHER_WIDTH_SHIFT 4u
#define ENDAT_MAP_SERVICE_STATE_OTHER_WIDTH_MASK 0x00000010u
/* slower: The encoder supports only a slower clock than configured, which the card uses */
#define ENDAT_MAP_SERVICE_STATE_SLOWER_SHIFT 5u
#define ENDAT_MAP_SERVICE_STATE_SLOWER_MASK 0x00000020u
/* unplugged: DATA has been HIGH for long: no encoder, or an open line */
#define ENDAT_MAP_SERVICE_STATE_UNPLUGGED_SHIFT 6u
#define ENDAT_MAP_SERVICE_STATE_UNPLUGGED_MASK 0x00000040u
/* initialising: power-up sequence or initialisation is under way; triggers are lost */
#define ENDAT_MAP_SERVICE_STATE_INITIALISING_SHIFT 7u
#define ENDAT_MAP_SERVICE_STATE_INITIALISING_MASK 0x00000080u
/* error_test: A forced error was not reported; latched */
#define ENDAT_MAP_SERVICE_STATE_ERROR_TEST_SHIFT 8u
#define ENDAT_MAP_SERVICE_STATE_ERROR_TEST_MASK 0x00000100u
/* starts: Starts of the program since power-up, wrapping: one for each reset, and one for each upset that made it restart */
#define ENDAT_MAP_SERVICE_STATE_STARTS_SHIFT 16u
#define ENDAT_MAP_SERVICE_STATE_STARTS_MASK 0xFFFF0000u

/* ro: Triggers and frames that were dropped. */
#define ENDAT_MAP_SERVICE_LOST_WORD(channel) (0x409u + 128u * (channel))
#define ENDAT_MAP_SERVICE_LOST_BYTE(channel) (0x1024u + 512u * (channel))
/* triggers: Triggers lost because the line was busy, wrapping */
#define ENDAT_MAP_SERVICE_LOST_TRIGGERS_SHIFT 0u
#define ENDAT_MAP_SERVICE_LOST_TRIGGERS_MASK 0x0000FFFFu
/* ends: Frames that ended before the previous one was counted */
#define ENDAT_MAP_SERVICE_LOST_ENDS_SHIFT 16u
#define ENDAT_MAP_SERVICE_LOST_ENDS_MASK 0xFFFF0000u

/* rw: Alarm: n bad frames of the last m. */
#define ENDAT_MAP_SERVICE_THRESHOLD_WORD(channel) (0x40Au + 128u * (channel))
#define ENDAT_MAP_SERVICE_THRESHOLD_BYTE(channel) (0x1028u + 512u * (channel))
/* n: 0 = no alarm (frames) */
#define ENDAT_MAP_SERVICE_THRESHOLD_N_SHIFT 0u
#define ENDAT_MAP_SERVICE_THRESHOLD_N_MASK 0x0000FFFFu
/* m: 1..16; changing m starts a new count (frames) */
#define ENDAT_MAP_SERVICE_THRESHOLD_M_SHIFT 16u
#define ENDAT_MAP_SERVICE_THRESHOLD_M_MASK 0xFFFF0000u

/* ro: Bad frames of the last m. */
#define ENDAT_MAP_SERVICE_BAD_FRAMES_WORD(channel) (0x40Bu + 128u * (channel))
#define ENDAT_MAP_SERVICE_BAD_FRAMES_BYTE(channel) (0x102Cu + 512u * (channel))
/* count: How many (frames) */
#define ENDAT_MAP_SERVICE_BAD_FRAMES_COUNT_SHIFT 0u
#define ENDAT_MAP_SERVICE_BAD_FRAMES_COUNT_MASK 0x0000FFFFu
/* which: Bit 0 = the last frame */
#define ENDAT_MAP_SERVICE_BAD_FRAMES_WHICH_SHIFT 16u
#define ENDAT_MAP_SERVICE_BAD_FRAMES_WHICH_MASK 0xFFFF0000u

/* rw: Nominal difference: position 2 minus position 1, bits 31..0. */
#define ENDAT_MAP_SERVICE_OFFSET_LOW_WORD(channel) (0x40Cu + 128u * (channel))
#define ENDAT_MAP_SERVICE_OFFSET_LOW_BYTE(channel) (0x1030u + 512u * (channel))
/* value: Number */
#define ENDAT_MAP_SERVICE_OFFSET_LOW_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_OFFSET_LOW_VALUE_MASK 0xFFFFFFFFu

/* rw: Nominal difference, bits 47..32. */
#define ENDAT_MAP_SERVICE_OFFSET_HIGH_WORD(channel) (0x40Du + 128u * (channel))
#define ENDAT_MAP_SERVICE_OFFSET_HIGH_BYTE(channel) (0x1034u + 512u * (channel))
/* value: Bits 47..32 */
#define ENDAT_MAP_SERVICE_OFFSET_HIGH_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_OFFSET_HIGH_VALUE_MASK 0x0000FFFFu

/* rw: Largest allowed distance from the nominal difference; 0 = no comparison. */
#define ENDAT_MAP_SERVICE_TOLERANCE_WORD(channel) (0x40Eu + 128u * (channel))
#define ENDAT_MAP_SERVICE_TOLERANCE_BYTE(channel) (0x1038u + 512u * (channel))
/* value: Number */
#define ENDAT_MAP_SERVICE_TOLERANCE_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_TOLERANCE_VALUE_MASK 0xFFFFFFFFu

/* ro: Position 2 minus position 1 minus offset, modulo the position's width, bits 31..0. */
#define ENDAT_MAP_SERVICE_DIFFERENCE_LOW_WORD(channel) (0x40Fu + 128u * (channel))
#define ENDAT_MAP_SERVICE_DIFFERENCE_LOW_BYTE(channel) (0x103Cu + 512u * (channel))
/* value: Number */
#define ENDAT_MAP_SERVICE_DIFFERENCE_LOW_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_DIFFERENCE_LOW_VALUE_MASK 0xFFFFFFFFu

/* ro: Position 2 minus position 1 minus offset, bits 47..32. */
#define ENDAT_MAP_SERVICE_DIFFERENCE_HIGH_WORD(channel) (0x410u + 128u * (channel))
#define ENDAT_MAP_SERVICE_DIFFERENCE_HIGH_BYTE(channel) (0x1040u + 512u * (channel))
/* value: Bits 47..32 */
#define ENDAT_MAP_SERVICE_DIFFERENCE_HIGH_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_DIFFERENCE_HIGH_VALUE_MASK 0x0000FFFFu

/* ro: Comparisons of positions 1 and 2. */
#define ENDAT_MAP_SERVICE_COMPARISONS_WORD(channel) (0x411u + 128u * (channel))
#define ENDAT_MAP_SERVICE_COMPARISONS_BYTE(channel) (0x1044u + 512u * (channel))
/* all: All, wrapping */
#define ENDAT_MAP_SERVICE_COMPARISONS_ALL_SHIFT 0u
#define ENDAT_MAP_SERVICE_COMPARISONS_ALL_MASK 0x0000FFFFu
/* failed: Comparisons that failed, wrapping */
#define ENDAT_MAP_SERVICE_COMPARISONS_FAILED_SHIFT 16u
#define ENDAT_MAP_SERVICE_COMPARISONS_FAILED_MASK 0xFFFF0000u

/* ro: Position 2, bits 31..0. */
#define ENDAT_MAP_SERVICE_POSITION_2_LOW_WORD(channel) (0x412u + 128u * (channel))
#define ENDAT_MAP_SERVICE_POSITION_2_LOW_BYTE(channel) (0x1048u + 512u * (channel))
/* value: Number */
#define ENDAT_MAP_SERVICE_POSITION_2_LOW_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_POSITION_2_LOW_VALUE_MASK 0xFFFFFFFFu

/* ro: Position 2, bits 47..32. */
#define ENDAT_MAP_SERVICE_POSITION_2_HIGH_WORD(channel) (0x413u + 128u * (channel))
#define ENDAT_MAP_SERVICE_POSITION_2_HIGH_BYTE(channel) (0x104Cu + 512u * (channel))
/* value: Bits 47..32 */
#define ENDAT_MAP_SERVICE_POSITION_2_HIGH_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_POSITION_2_HIGH_VALUE_MASK 0x0000FFFFu

/* rw: Length of the list of codes that are selected in turn. */
#define ENDAT_MAP_SERVICE_LIST_LENGTH_WORD(channel) (0x414u + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIST_LENGTH_BYTE(channel) (0x1050u + 512u * (channel))
/* length: 0..8; more is 8 */
#define ENDAT_MAP_SERVICE_LIST_LENGTH_LENGTH_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIST_LENGTH_LENGTH_MASK 0x0000000Fu

/* ro: Last WRN, RM, Busy, I4..I0 with a right CRC. */
#define ENDAT_MAP_SERVICE_INFO_STATUS_WORD(channel) (0x415u + 128u * (channel))
#define ENDAT_MAP_SERVICE_INFO_STATUS_BYTE(channel) (0x1054u + 512u * (channel))
/* info_1: From additional data 1 */
#define ENDAT_MAP_SERVICE_INFO_STATUS_INFO_1_SHIFT 0u
#define ENDAT_MAP_SERVICE_INFO_STATUS_INFO_1_MASK 0x000000FFu
/* crc_1: CRC of the last additional data 1 was wrong; its content was discarded */
#define ENDAT_MAP_SERVICE_INFO_STATUS_CRC_1_SHIFT 8u
#define ENDAT_MAP_SERVICE_INFO_STATUS_CRC_1_MASK 0x00000100u
/* info_2: From additional data 2 */
#define ENDAT_MAP_SERVICE_INFO_STATUS_INFO_2_SHIFT 16u
#define ENDAT_MAP_SERVICE_INFO_STATUS_INFO_2_MASK 0x00FF0000u
/* crc_2: CRC of the last additional data 2 was wrong; its content was discarded */
#define ENDAT_MAP_SERVICE_INFO_STATUS_CRC_2_SHIFT 24u
#define ENDAT_MAP_SERVICE_INFO_STATUS_CRC_2_MASK 0x01000000u

/* rw: Time limits of a frame. */
#define ENDAT_MAP_SERVICE_LIMITS_WORD(channel) (0x416u + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIMITS_BYTE(channel) (0x1058u + 512u * (channel))
/* watchdog_us: Longest time from the first falling edge to the end of the recovery time; 0 = off. Not applied to 101010, 100011, 011100, continuous clock and initialisation (us) */
#define ENDAT_MAP_SERVICE_LIMITS_WATCHDOG_US_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIMITS_WATCHDOG_US_MASK 0x00000FFFu
/* recovery_min_cycles: Shortest recovery time; 0 = not checked. At start the program writes the lower end of the configured range (cycles) */
#define ENDAT_MAP_SERVICE_LIMITS_RECOVERY_MIN_CYCLES_SHIFT 16u
#define ENDAT_MAP_SERVICE_LIMITS_RECOVERY_MIN_CYCLES_MASK 0x1FFF0000u

/* rw: Continuous clock, for the command 000111. */
#define ENDAT_MAP_SERVICE_CONTINUOUS_WORD(channel) (0x417u + 128u * (channel))
#define ENDAT_MAP_SERVICE_CONTINUOUS_BYTE(channel) (0x105Cu + 512u * (channel))
/* go_on: 1: the clock continues after each position, from the next trigger on */
#define ENDAT_MAP_SERVICE_CONTINUOUS_GO_ON_SHIFT 0u
#define ENDAT_MAP_SERVICE_CONTINUOUS_GO_ON_MASK 0x00000001u
/* stop_at_error: 1: the clock stops after an error until the next trigger; 0: it continues after CRC, F1 and F2 */
#define ENDAT_MAP_SERVICE_CONTINUOUS_STOP_AT_ERROR_SHIFT 1u
#define ENDAT_MAP_SERVICE_CONTINUOUS_STOP_AT_ERROR_MASK 0x00000002u

/* rw: A code of the list. */
#define ENDAT_MAP_SERVICE_LIST_0_WORD(channel) (0x418u + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIST_0_BYTE(channel) (0x1060u + 512u * (channel))
/* mrs: MRS code 0x40..0x5E */
#define ENDAT_MAP_SERVICE_LIST_0_MRS_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIST_0_MRS_MASK 0x000000FFu

/* rw: A code of the list. */
#define ENDAT_MAP_SERVICE_LIST_1_WORD(channel) (0x419u + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIST_1_BYTE(channel) (0x1064u + 512u * (channel))
/* mrs: MRS code 0x40..0x5E */
#define ENDAT_MAP_SERVICE_LIST_1_MRS_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIST_1_MRS_MASK 0x000000FFu

/* rw: A code of the list. */
#define ENDAT_MAP_SERVICE_LIST_2_WORD(channel) (0x41Au + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIST_2_BYTE(channel) (0x1068u + 512u * (channel))
/* mrs: MRS code 0x40..0x5E */
#define ENDAT_MAP_SERVICE_LIST_2_MRS_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIST_2_MRS_MASK 0x000000FFu

/* rw: A code of the list. */
#define ENDAT_MAP_SERVICE_LIST_3_WORD(channel) (0x41Bu + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIST_3_BYTE(channel) (0x106Cu + 512u * (channel))
/* mrs: MRS code 0x40..0x5E */
#define ENDAT_MAP_SERVICE_LIST_3_MRS_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIST_3_MRS_MASK 0x000000FFu

/* rw: A code of the list. */
#define ENDAT_MAP_SERVICE_LIST_4_WORD(channel) (0x41Cu + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIST_4_BYTE(channel) (0x1070u + 512u * (channel))
/* mrs: MRS code 0x40..0x5E */
#define ENDAT_MAP_SERVICE_LIST_4_MRS_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIST_4_MRS_MASK 0x000000FFu

/* rw: A code of the list. */
#define ENDAT_MAP_SERVICE_LIST_5_WORD(channel) (0x41Du + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIST_5_BYTE(channel) (0x1074u + 512u * (channel))
/* mrs: MRS code 0x40..0x5E */
#define ENDAT_MAP_SERVICE_LIST_5_MRS_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIST_5_MRS_MASK 0x000000FFu

/* rw: A code of the list. */
#define ENDAT_MAP_SERVICE_LIST_6_WORD(channel) (0x41Eu + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIST_6_BYTE(channel) (0x1078u + 512u * (channel))
/* mrs: MRS code 0x40..0x5E */
#define ENDAT_MAP_SERVICE_LIST_6_MRS_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIST_6_MRS_MASK 0x000000FFu

/* rw: A code of the list. */
#define ENDAT_MAP_SERVICE_LIST_7_WORD(channel) (0x41Fu + 128u * (channel))
#define ENDAT_MAP_SERVICE_LIST_7_BYTE(channel) (0x107Cu + 512u * (channel))
/* mrs: MRS code 0x40..0x5E */
#define ENDAT_MAP_SERVICE_LIST_7_MRS_SHIFT 0u
#define ENDAT_MAP_SERVICE_LIST_7_MRS_MASK 0x000000FFu

/* ro: Last content of the additional data with that code. */
#define ENDAT_MAP_SERVICE_SLOT_0_WORD(channel) (0x420u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SLOT_0_BYTE(channel) (0x1080u + 512u * (channel))
/* value: Content */
#define ENDAT_MAP_SERVICE_SLOT_0_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SLOT_0_VALUE_MASK 0x0000FFFFu
/* sequence: status.sequence of the frame that brought it; the difference is its age */
#define ENDAT_MAP_SERVICE_SLOT_0_SEQUENCE_SHIFT 16u
#define ENDAT_MAP_SERVICE_SLOT_0_SEQUENCE_MASK 0xFFFF0000u

/* ro: Last content of the additional data with that code. */
#define ENDAT_MAP_SERVICE_SLOT_1_WORD(channel) (0x421u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SLOT_1_BYTE(channel) (0x1084u + 512u * (channel))
/* value: Content */
#define ENDAT_MAP_SERVICE_SLOT_1_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SLOT_1_VALUE_MASK 0x0000FFFFu
/* sequence: status.sequence of the frame that brought it; the difference is its age */
#define ENDAT_MAP_SERVICE_SLOT_1_SEQUENCE_SHIFT 16u
#define ENDAT_MAP_SERVICE_SLOT_1_SEQUENCE_MASK 0xFFFF0000u

/* ro: Last content of the additional data with that code. */
#define ENDAT_MAP_SERVICE_SLOT_2_WORD(channel) (0x422u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SLOT_2_BYTE(channel) (0x1088u + 512u * (channel))
/* value: Content */
#define ENDAT_MAP_SERVICE_SLOT_2_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SLOT_2_VALUE_MASK 0x0000FFFFu
/* sequence: status.sequence of the frame that brought it; the difference is its age */
#define ENDAT_MAP_SERVICE_SLOT_2_SEQUENCE_SHIFT 16u
#define ENDAT_MAP_SERVICE_SLOT_2_SEQUENCE_MASK 0xFFFF0000u

/* ro: Last content of the additional data with that code. */
#define ENDAT_MAP_SERVICE_SLOT_3_WORD(channel) (0x423u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SLOT_3_BYTE(channel) (0x108Cu + 512u * (channel))
/* value: Content */
#define ENDAT_MAP_SERVICE_SLOT_3_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SLOT_3_VALUE_MASK 0x0000FFFFu
/* sequence: status.sequence of the frame that brought it; the difference is its age */
#define ENDAT_MAP_SERVICE_SLOT_3_SEQUENCE_SHIFT 16u
#define ENDAT_MAP_SERVICE_SLOT_3_SEQUENCE_MASK 0xFFFF0000u

/* ro: Last content of the additional data with that code. */
#define ENDAT_MAP_SERVICE_SLOT_4_WORD(channel) (0x424u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SLOT_4_BYTE(channel) (0x1090u + 512u * (channel))
/* value: Content */
#define ENDAT_MAP_SERVICE_SLOT_4_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SLOT_4_VALUE_MASK 0x0000FFFFu
/* sequence: status.sequence of the frame that brought it; the difference is its age */
#define ENDAT_MAP_SERVICE_SLOT_4_SEQUENCE_SHIFT 16u
#define ENDAT_MAP_SERVICE_SLOT_4_SEQUENCE_MASK 0xFFFF0000u

/* ro: Last content of the additional data with that code. */
#define ENDAT_MAP_SERVICE_SLOT_5_WORD(channel) (0x425u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SLOT_5_BYTE(channel) (0x1094u + 512u * (channel))
/* value: Content */
#define ENDAT_MAP_SERVICE_SLOT_5_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SLOT_5_VALUE_MASK 0x0000FFFFu
/* sequence: status.sequence of the frame that brought it; the difference is its age */
#define ENDAT_MAP_SERVICE_SLOT_5_SEQUENCE_SHIFT 16u
#define ENDAT_MAP_SERVICE_SLOT_5_SEQUENCE_MASK 0xFFFF0000u

/* ro: Last content of the additional data with that code. */
#define ENDAT_MAP_SERVICE_SLOT_6_WORD(channel) (0x426u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SLOT_6_BYTE(channel) (0x1098u + 512u * (channel))
/* value: Content */
#define ENDAT_MAP_SERVICE_SLOT_6_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SLOT_6_VALUE_MASK 0x0000FFFFu
/* sequence: status.sequence of the frame that brought it; the difference is its age */
#define ENDAT_MAP_SERVICE_SLOT_6_SEQUENCE_SHIFT 16u
#define ENDAT_MAP_SERVICE_SLOT_6_SEQUENCE_MASK 0xFFFF0000u

/* ro: Last content of the additional data with that code. */
#define ENDAT_MAP_SERVICE_SLOT_7_WORD(channel) (0x427u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SLOT_7_BYTE(channel) (0x109Cu + 512u * (channel))
/* value: Content */
#define ENDAT_MAP_SERVICE_SLOT_7_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SLOT_7_VALUE_MASK 0x0000FFFFu
/* sequence: status.sequence of the frame that brought it; the difference is its age */
#define ENDAT_MAP_SERVICE_SLOT_7_SEQUENCE_SHIFT 16u
#define ENDAT_MAP_SERVICE_SLOT_7_SEQUENCE_MASK 0xFFFF0000u

/* rw: Timeout of a request that waits for a trigger. */
#define ENDAT_MAP_SERVICE_REQUEST_WAIT_WORD(channel) (0x428u + 128u * (channel))
#define ENDAT_MAP_SERVICE_REQUEST_WAIT_BYTE(channel) (0x10A0u + 512u * (channel))
/* ms: 0 = no timeout. The program writes 2000 at start (ms) */
#define ENDAT_MAP_SERVICE_REQUEST_WAIT_MS_SHIFT 0u
#define ENDAT_MAP_SERVICE_REQUEST_WAIT_MS_MASK 0x0000FFFFu

/* rw: Forced errors on the card's schedule. */
#define ENDAT_MAP_SERVICE_ERROR_TEST_WORD(channel) (0x429u + 128u * (channel))
#define ENDAT_MAP_SERVICE_ERROR_TEST_BYTE(channel) (0x10A4u + 512u * (channel))
/* period_ms: Period of the forced errors, each in a separate frame: 10 to 32000, 0 = none. Initial value: safety.error_test_ms of the configuration (ms) */
#define ENDAT_MAP_SERVICE_ERROR_TEST_PERIOD_MS_SHIFT 0u
#define ENDAT_MAP_SERVICE_ERROR_TEST_PERIOD_MS_MASK 0x0000FFFFu

/* ro: Results of the forced errors. */
#define ENDAT_MAP_SERVICE_ERROR_TEST_STATE_WORD(channel) (0x42Au + 128u * (channel))
#define ENDAT_MAP_SERVICE_ERROR_TEST_STATE_BYTE(channel) (0x10A8u + 512u * (channel))
/* told: Forced errors reported with their cause, since clear, wrapping */
#define ENDAT_MAP_SERVICE_ERROR_TEST_STATE_TOLD_SHIFT 0u
#define ENDAT_MAP_SERVICE_ERROR_TEST_STATE_TOLD_MASK 0x0000FFFFu
/* silent: Forced errors whose frame was reported as good, since clear */
#define ENDAT_MAP_SERVICE_ERROR_TEST_STATE_SILENT_SHIFT 16u
#define ENDAT_MAP_SERVICE_ERROR_TEST_STATE_SILENT_MASK 0xFFFF0000u

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_GOOD_WORD(channel) (0x430u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_GOOD_BYTE(channel) (0x10C0u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_GOOD_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_GOOD_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_DATA_NOT_LOW_WORD(channel) (0x431u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_DATA_NOT_LOW_BYTE(channel) (0x10C4u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_DATA_NOT_LOW_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_DATA_NOT_LOW_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_NO_START_BIT_WORD(channel) (0x432u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_NO_START_BIT_BYTE(channel) (0x10C8u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_NO_START_BIT_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_NO_START_BIT_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_START_WINDOW_WORD(channel) (0x433u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_START_WINDOW_BYTE(channel) (0x10CCu + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_START_WINDOW_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_START_WINDOW_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_CRC_WORD(channel) (0x434u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_CRC_BYTE(channel) (0x10D0u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_CRC_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_CRC_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_F1_WORD(channel) (0x435u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_F1_BYTE(channel) (0x10D4u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_F1_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_F1_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_F2_WORD(channel) (0x436u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_F2_BYTE(channel) (0x10D8u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_F2_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_F2_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_DATA_NOT_FALLING_WORD(channel) (0x437u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_DATA_NOT_FALLING_BYTE(channel) (0x10DCu + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_DATA_NOT_FALLING_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_DATA_NOT_FALLING_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_TRIGGER_OVERRUN_WORD(channel) (0x438u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_TRIGGER_OVERRUN_BYTE(channel) (0x10E0u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_TRIGGER_OVERRUN_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_TRIGGER_OVERRUN_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_UNKNOWN_COMMAND_WORD(channel) (0x439u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_UNKNOWN_COMMAND_BYTE(channel) (0x10E4u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_UNKNOWN_COMMAND_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_UNKNOWN_COMMAND_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_INFO_MISSING_WORD(channel) (0x43Au + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_INFO_MISSING_BYTE(channel) (0x10E8u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_INFO_MISSING_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_INFO_MISSING_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_NO_ENCODER_WORD(channel) (0x43Bu + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_NO_ENCODER_BYTE(channel) (0x10ECu + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_NO_ENCODER_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_NO_ENCODER_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_STUCK_HIGH_WORD(channel) (0x43Cu + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_STUCK_HIGH_BYTE(channel) (0x10F0u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_STUCK_HIGH_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_STUCK_HIGH_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_STUCK_LOW_WORD(channel) (0x43Du + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_STUCK_LOW_BYTE(channel) (0x10F4u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_STUCK_LOW_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_STUCK_LOW_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_LATE_START_WORD(channel) (0x43Eu + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_LATE_START_BYTE(channel) (0x10F8u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_LATE_START_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_LATE_START_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_WATCHDOG_WORD(channel) (0x43Fu + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_WATCHDOG_BYTE(channel) (0x10FCu + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_WATCHDOG_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_WATCHDOG_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_OWN_ECHO_WORD(channel) (0x440u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_OWN_ECHO_BYTE(channel) (0x1100u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_OWN_ECHO_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_OWN_ECHO_FRAMES_MASK 0xFFFFFFFFu

/* ro: Frames that ended with this cause (good: without one). */
#define ENDAT_MAP_SERVICE_FRAMES_RECOVERY_TOO_SHORT_WORD(channel) (0x441u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_RECOVERY_TOO_SHORT_BYTE(channel) (0x1104u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_RECOVERY_TOO_SHORT_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_RECOVERY_TOO_SHORT_FRAMES_MASK 0xFFFFFFFFu

/* ro: Failed comparisons of positions 1 and 2. */
#define ENDAT_MAP_SERVICE_FRAMES_POSITION_2_WORD(channel) (0x442u + 128u * (channel))
#define ENDAT_MAP_SERVICE_FRAMES_POSITION_2_BYTE(channel) (0x1108u + 512u * (channel))
/* frames: Frames since clear, wrapping */
#define ENDAT_MAP_SERVICE_FRAMES_POSITION_2_FRAMES_SHIFT 0u
#define ENDAT_MAP_SERVICE_FRAMES_POSITION_2_FRAMES_MASK 0xFFFFFFFFu

/* ro: Blocks of additional data with a wrong CRC. */
#define ENDAT_MAP_SERVICE_BAD_INFOS_WORD(channel) (0x443u + 128u * (channel))
#define ENDAT_MAP_SERVICE_BAD_INFOS_BYTE(channel) (0x110Cu + 512u * (channel))
/* count: Since clear, wrapping */
#define ENDAT_MAP_SERVICE_BAD_INFOS_COUNT_SHIFT 0u
#define ENDAT_MAP_SERVICE_BAD_INFOS_COUNT_MASK 0xFFFFFFFFu

/* ro: Alarms before they were cleared */
#define ENDAT_MAP_SERVICE_ALARMS_WORD(channel) (0x444u + 128u * (channel))
#define ENDAT_MAP_SERVICE_ALARMS_BYTE(channel) (0x1110u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_ALARMS_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_ALARMS_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_ALARMS_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_ALARMS_IS_READ_MASK 0x00010000u

/* ro: Warnings before they were cleared */
#define ENDAT_MAP_SERVICE_WARNINGS_WORD(channel) (0x445u + 128u * (channel))
#define ENDAT_MAP_SERVICE_WARNINGS_BYTE(channel) (0x1114u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_WARNINGS_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_WARNINGS_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_WARNINGS_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_WARNINGS_IS_READ_MASK 0x00010000u

/* ro: Word 13: clock pulses for the position in bits 5..0 */
#define ENDAT_MAP_SERVICE_POSITION_BITS_WORD(channel) (0x446u + 128u * (channel))
#define ENDAT_MAP_SERVICE_POSITION_BITS_BYTE(channel) (0x1118u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_POSITION_BITS_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_POSITION_BITS_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_POSITION_BITS_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_POSITION_BITS_IS_READ_MASK 0x00010000u

/* ro: Word 14: bit 15: 1 = rotary, 0 = linear */
#define ENDAT_MAP_SERVICE_ENCODER_TYPE_WORD(channel) (0x447u + 128u * (channel))
#define ENDAT_MAP_SERVICE_ENCODER_TYPE_BYTE(channel) (0x111Cu + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_ENCODER_TYPE_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_ENCODER_TYPE_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_ENCODER_TYPE_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_ENCODER_TYPE_IS_READ_MASK 0x00010000u

/* ro: Word 15: signal periods per revolution, or in nm */
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_LOW_WORD(channel) (0x448u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_LOW_BYTE(channel) (0x1120u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_LOW_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_LOW_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_LOW_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_LOW_IS_READ_MASK 0x00010000u

/* ro: Word 16: upper part of word 15 */
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_HIGH_WORD(channel) (0x449u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_HIGH_BYTE(channel) (0x1124u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_HIGH_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_HIGH_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_HIGH_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_SIGNAL_PERIODS_HIGH_IS_READ_MASK 0x00010000u

/* ro: Word 17: distinguishable revolutions */
#define ENDAT_MAP_SERVICE_REVOLUTIONS_WORD(channel) (0x44Au + 128u * (channel))
#define ENDAT_MAP_SERVICE_REVOLUTIONS_BYTE(channel) (0x1128u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_REVOLUTIONS_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_REVOLUTIONS_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_REVOLUTIONS_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_REVOLUTIONS_IS_READ_MASK 0x00010000u

/* ro: Word 20: measuring steps per revolution, or step in nm */
#define ENDAT_MAP_SERVICE_STEPS_LOW_WORD(channel) (0x44Bu + 128u * (channel))
#define ENDAT_MAP_SERVICE_STEPS_LOW_BYTE(channel) (0x112Cu + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_STEPS_LOW_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_STEPS_LOW_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_STEPS_LOW_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_STEPS_LOW_IS_READ_MASK 0x00010000u

/* ro: Word 21: upper part of word 20 */
#define ENDAT_MAP_SERVICE_STEPS_HIGH_WORD(channel) (0x44Cu + 128u * (channel))
#define ENDAT_MAP_SERVICE_STEPS_HIGH_BYTE(channel) (0x1130u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_STEPS_HIGH_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_STEPS_HIGH_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_STEPS_HIGH_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_STEPS_HIGH_IS_READ_MASK 0x00010000u

/* ro: Word 24: ID number, two ASCII characters */
#define ENDAT_MAP_SERVICE_ID_0_WORD(channel) (0x44Du + 128u * (channel))
#define ENDAT_MAP_SERVICE_ID_0_BYTE(channel) (0x1134u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_ID_0_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_ID_0_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_ID_0_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_ID_0_IS_READ_MASK 0x00010000u

/* ro: Word 25: ID number, low */
#define ENDAT_MAP_SERVICE_ID_1_WORD(channel) (0x44Eu + 128u * (channel))
#define ENDAT_MAP_SERVICE_ID_1_BYTE(channel) (0x1138u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_ID_1_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_ID_1_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_ID_1_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_ID_1_IS_READ_MASK 0x00010000u

/* ro: Word 26: ID number, high */
#define ENDAT_MAP_SERVICE_ID_2_WORD(channel) (0x44Fu + 128u * (channel))
#define ENDAT_MAP_SERVICE_ID_2_BYTE(channel) (0x113Cu + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_ID_2_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_ID_2_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_ID_2_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_ID_2_IS_READ_MASK 0x00010000u

/* ro: Word 27: serial number: high byte, ASCII character */
#define ENDAT_MAP_SERVICE_SERIAL_0_WORD(channel) (0x450u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SERIAL_0_BYTE(channel) (0x1140u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_SERIAL_0_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SERIAL_0_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_SERIAL_0_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_SERIAL_0_IS_READ_MASK 0x00010000u

/* ro: Word 28: serial number, middle */
#define ENDAT_MAP_SERVICE_SERIAL_1_WORD(channel) (0x451u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SERIAL_1_BYTE(channel) (0x1144u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_SERIAL_1_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SERIAL_1_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_SERIAL_1_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_SERIAL_1_IS_READ_MASK 0x00010000u

/* ro: Word 29: ASCII character, serial number low byte */
#define ENDAT_MAP_SERVICE_SERIAL_2_WORD(channel) (0x452u + 128u * (channel))
#define ENDAT_MAP_SERVICE_SERIAL_2_BYTE(channel) (0x1148u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_SERIAL_2_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_SERIAL_2_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_SERIAL_2_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_SERIAL_2_IS_READ_MASK 0x00010000u

/* ro: Word 37: bits 1..0 = 01: EnDat 2.2; bits 3..2 = 01: functional safety */
#define ENDAT_MAP_SERVICE_COMMANDS_WORD(channel) (0x453u + 128u * (channel))
#define ENDAT_MAP_SERVICE_COMMANDS_BYTE(channel) (0x114Cu + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_COMMANDS_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_COMMANDS_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_COMMANDS_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_COMMANDS_IS_READ_MASK 0x00010000u

/* ro: Word 39: longest calculation time */
#define ENDAT_MAP_SERVICE_TCAL_WORD(channel) (0x454u + 128u * (channel))
#define ENDAT_MAP_SERVICE_TCAL_BYTE(channel) (0x1150u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_TCAL_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_TCAL_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_TCAL_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_TCAL_IS_READ_MASK 0x00010000u

/* ro: EnDat 2.2 word 0: supported additional data 1 */
#define ENDAT_MAP_SERVICE_INFOS_1_WORD(channel) (0x455u + 128u * (channel))
#define ENDAT_MAP_SERVICE_INFOS_1_BYTE(channel) (0x1154u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_INFOS_1_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_INFOS_1_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_INFOS_1_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_INFOS_1_IS_READ_MASK 0x00010000u

/* ro: EnDat 2.2 word 1: supported additional data 2 */
#define ENDAT_MAP_SERVICE_INFOS_2_WORD(channel) (0x456u + 128u * (channel))
#define ENDAT_MAP_SERVICE_INFOS_2_BYTE(channel) (0x1158u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_INFOS_2_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_INFOS_2_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_INFOS_2_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_INFOS_2_IS_READ_MASK 0x00010000u

/* ro: EnDat 2.2 word 25: fastest clock, in kHz */
#define ENDAT_MAP_SERVICE_CLOCK_MAX_KHZ_WORD(channel) (0x457u + 128u * (channel))
#define ENDAT_MAP_SERVICE_CLOCK_MAX_KHZ_BYTE(channel) (0x115Cu + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_CLOCK_MAX_KHZ_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_CLOCK_MAX_KHZ_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_CLOCK_MAX_KHZ_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_CLOCK_MAX_KHZ_IS_READ_MASK 0x00010000u

/* ro: Word 3 of the operating status as set: bits 1..0 = 10: 10 to 30 us, 01: 1.25 to 3.75 us */
#define ENDAT_MAP_SERVICE_RECOVERY_WORD(channel) (0x458u + 128u * (channel))
#define ENDAT_MAP_SERVICE_RECOVERY_BYTE(channel) (0x1160u + 512u * (channel))
/* value: Content of the encoder's word */
#define ENDAT_MAP_SERVICE_RECOVERY_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_RECOVERY_VALUE_MASK 0x0000FFFFu
/* is_read: The word has been read */
#define ENDAT_MAP_SERVICE_RECOVERY_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_RECOVERY_IS_READ_MASK 0x00010000u

/* ro: Line delay measured at initialisation. */
#define ENDAT_MAP_SERVICE_DELAY_WORD(channel) (0x459u + 128u * (channel))
#define ENDAT_MAP_SERVICE_DELAY_BYTE(channel) (0x1164u + 512u * (channel))
/* value: tD, including synchroniser and filter (cycles) */
#define ENDAT_MAP_SERVICE_DELAY_VALUE_SHIFT 0u
#define ENDAT_MAP_SERVICE_DELAY_VALUE_MASK 0x0000FFFFu
/* is_read: The delay has been measured */
#define ENDAT_MAP_SERVICE_DELAY_IS_READ_SHIFT 16u
#define ENDAT_MAP_SERVICE_DELAY_IS_READ_MASK 0x00010000u

/* What m takes */
#define ENDAT_MAP_SERVICE_THRESHOLD_M_MIN 1u
#define ENDAT_MAP_SERVICE_THRESHOLD_M_MAX 16u

/* What length takes */
#define ENDAT_MAP_SERVICE_LIST_LENGTH_LENGTH_MIN 0u
#define ENDAT_MAP_SERVICE_LIST_LENGTH_LENGTH_MAX 8u

/* What a channel speaks */
#define ENDAT_PROTOCOL_ENDAT 0u /* EnDat 2.1/2.2 */
#define ENDAT_PROTOCOL_T_FORMAT 1u /* T-format */
#define ENDAT_PROTOCOL_SSI 2u /* SSI */

/* Causes as the driver tells them, of all protocols */
#define ENDAT_CAUSE_NONE 0u /* none */
#define ENDAT_CAUSE_DATA_NOT_LOW 1u /* data not low before start */
#define ENDAT_CAUSE_NO_START_BIT 2u /* no start bit */
#define ENDAT_CAUSE_START_WINDOW 3u /* start bit outside its window */
#define ENDAT_CAUSE_CRC 4u /* CRC */
#define ENDAT_CAUSE_F1 5u /* F1 */
#define ENDAT_CAUSE_F2 6u /* F2 */
#define ENDAT_CAUSE_DATA_NOT_FALLING 7u /* data not falling after the frame */
#define ENDAT_CAUSE_TRIGGER_OVERRUN 8u /* trigger overrun */
#define ENDAT_CAUSE_UNKNOWN_COMMAND 9u /* unknown mode command */
#define ENDAT_CAUSE_INFO_MISSING 10u /* additional data missing */
#define ENDAT_CAUSE_NO_ENCODER 11u /* no encoder */
#define ENDAT_CAUSE_STUCK_HIGH 12u /* data stuck high */
#define ENDAT_CAUSE_STUCK_LOW 13u /* data stuck low */
#define ENDAT_CAUSE_LATE_START 14u /* late start bit */
#define ENDAT_CAUSE_WATCHDOG 15u /* watchdog */
#define ENDAT_CAUSE_OWN_ECHO 16u /* echo of the own command */
#define ENDAT_CAUSE_RECOVERY_TOO_SHORT 17u /* recovery time too short */
#define ENDAT_CAUSE_UPSET 31u /* stored data upset */
#define ENDAT_CAUSE_LINE_NOT_IDLE 34u /* line not idle */
#define ENDAT_CAUSE_NO_ANSWER 35u /* no answer */
#define ENDAT_CAUSE_NO_HEADER 36u /* no header */
#define ENDAT_CAUSE_CONTROL_PARITY 37u /* parity of the control field */
#define ENDAT_CAUSE_REPLY_ECHO 38u /* another ID or address in the reply */
#define ENDAT_CAUSE_DELIMITER 39u /* delimiter */
#define ENDAT_CAUSE_FIELD_MISSING 40u /* field missing */
#define ENDAT_CAUSE_REPLY_CRC 41u /* CRC */
#define ENDAT_CAUSE_REQUEST_PARITY 42u /* encoder saw a parity error */
#define ENDAT_CAUSE_REQUEST_DELIMITER 43u /* encoder saw a delimiter error */
#define ENDAT_CAUSE_EEPROM_BUSY 44u /* EEPROM busy */
#define ENDAT_CAUSE_COUNTING_ERROR 45u /* counting error */
#define ENDAT_CAUSE_MULTI_TURN_ALARM 46u /* multi-turn or battery alarm */
#define ENDAT_CAUSE_UNKNOWN_FRAME 65u /* unknown kind of frame */
#define ENDAT_CAUSE_DATA_NOT_HIGH 66u /* data not high before the frame */
#define ENDAT_CAUSE_DATA_NOT_LOW_AFTER 67u /* data not low after the last bit */
#define ENDAT_CAUSE_POSITION_PARITY 68u /* parity of the position */
#define ENDAT_CAUSE_COPIES_DIFFER 69u /* the two copies differ */
#define ENDAT_CAUSE_RECOVERY_TOO_LONG 72u /* recovery time too long */
#define ENDAT_CAUSE_ENCODER_ALARM 73u /* alarm of the encoder */
#define ENDAT_CAUSE_POWER_FAIL 74u /* power failure of the encoder */
#define ENDAT_CAUSE_POSITION_NOT_VALID 75u /* the encoder marks the position not valid */
#define ENDAT_CAUSE_POSITION_CRC 76u /* CRC of the position */

#endif
