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
    assert bus.read(byte_address(SYSTEM_HZ)) == 100_000_000
    for value in (0x12345600, 0xFFFFFF00, 0):
        bus.write(byte_address(HOLD), value)
        assert bus.read(byte_address(HOLD)) == value
    words = bus.read(byte_address(RESULT), 14)
    assert len(words) == 14


def main(port):
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
    finally:
        server.terminate()
        server.wait()
    print("LITEX GOOD")


main(sys.argv[1])
