# SPDX-License-Identifier: MIT OR Apache-2.0
"""
T-format (Tamagawa type) is the asynchronous protocol of absolute position encoders: the receiver sends a request of one to four
fields, the encoder answers with its fields and a check sum. A field is ten bits: start (LOW), eight data bits LSB first, delimiter (HIGH).

Probe behind the line receiver, at either end: one wire.
"""

from .pd import Decoder
