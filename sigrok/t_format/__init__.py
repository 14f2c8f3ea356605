# SPDX-License-Identifier: MIT OR Apache-2.0
"""
T-format (Tamagawa type) is the asynchronous protocol of absolute position encoders: the receiver sends a request of one to four
fields, the encoder answers with its fields and a check sum. A field is ten bits: start (LOW), eight data bits LSB first, delimiter (HIGH).

Probe after the line receiver, at either end: one wire. LOW pulses of less than a bit and a half before a header are passed over.
"""

from .pd import Decoder
