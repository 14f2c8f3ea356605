# SPDX-License-Identifier: MIT OR Apache-2.0
"""
EnDat 2.1/2.2 is the serial protocol of absolute position encoders: the receiver sends a clock burst and a 6-bit mode command,
the encoder answers with a start bit, error bits, the position (LSB first), a CRC of 5 bits, and additional data.

Probe CLOCK and DATA after the line receivers, best at the encoder. At the receiver DATA can be later than a clock period: a warning says
so, and prints the delay for the option delay_ns.

EnDat is a trademark of DR. JOHANNES HEIDENHAIN GmbH; not affiliated.
"""

from .pd import Decoder
