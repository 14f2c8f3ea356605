# SPDX-License-Identifier: MIT OR Apache-2.0
"""
EnDat 2.1/2.2 is the serial protocol of absolute position encoders: the receiver sends a clock burst and a 6-bit mode command,
the encoder answers with a start bit, error bits, the position (LSB first), a CRC of 5 bits, and additional data.

Probe at the encoder's end, behind the line receivers: CLOCK and DATA.

EnDat is a trademark of DR. JOHANNES HEIDENHAIN GmbH; not affiliated.
"""

from .pd import Decoder
