"""LiteX's CommUART, directly and behind litex_server, at the port that is given."""

import subprocess
import sys
import time

from litex import RemoteClient
from litex.tools.remote.comm_uart import CommUART

ID, SYSTEM_HZ, HOLD, RESULT = 0x000, 0x003, 0x102, 0x180
BAUD = 2_000_000
SERVER_PORT = 18234


def byte_address(word):
    return 4 * word


def check(bus):
    assert bus.read(byte_address(ID)) == 0x456E4474
    assert bus.read(byte_address(SYSTEM_HZ)) == 10_000_000
    for value in (0x12345600, 0xFFFFFF00, 0):
        bus.write(byte_address(HOLD), value)
        assert bus.read(byte_address(HOLD)) == value
    words = bus.read(byte_address(RESULT), 14)
    assert len(words) == 14


def main(port, csr_csv):
    uart = CommUART(port, BAUD)
    uart.open()
    check(uart)
    first = uart.read(byte_address(RESULT)) & 0xFFFF
    while uart.read(byte_address(RESULT)) & 0xFFFF == first:
        pass
    uart.close()
    server = subprocess.Popen(
        [
            "litex_server",
            "--uart",
            f"--uart-port={port}",
            f"--uart-baudrate={BAUD}",
            f"--bind-port={SERVER_PORT}",
        ]
    )
    try:
        for _ in range(100):
            try:
                bus = RemoteClient(port=SERVER_PORT)
                bus.open()
                break
            except OSError:
                time.sleep(0.2)
        check(bus)
        bus.close()
        bus = RemoteClient(port=SERVER_PORT, csr_csv=csr_csv)
        bus.open()
        assert bus.regs.card_id.read() == 0x456E4474
        assert bus.constants.config_clock_frequency == 10_000_000
        assert bus.bases.result1 == byte_address(RESULT + 8)
        bus.close()
        shown = subprocess.check_output(
            ["litex_cli", "--csr-csv", csr_csv, "--port", str(SERVER_PORT), "--regs", "--filter", "card_"],
            text=True,
        )
        assert "0x00000000 : 0x456e4474 card_id" in shown, shown
    finally:
        server.terminate()
        server.wait()
    print("LITEX GOOD")


main(sys.argv[1], sys.argv[2])
