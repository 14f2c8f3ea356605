"""PandABlocks' client: finds blocks and fields, and records HDF5; its EPICS driver starts. Arguments: the program, a folder, "ioc" if
that driver is there."""

import asyncio
import os
import subprocess
import sys
from datetime import datetime
from pathlib import Path

import h5py
import numpy as np
from pandablocks.asyncio import AsyncioClient
from pandablocks.blocking import BlockingClient
from pandablocks.commands import Arm, Get, GetBlockInfo, GetFieldInfo, GetState, Identify
from pandablocks.responses import EndData, ReadyData, StartData

SAMPLES = 100
RATE_HZ = 2_500
CHANNELS = 2


async def introspect():
    async with AsyncioClient("127.0.0.1") as client:
        assert (await client.send(Get("*ECHO hello"))) == "hello"
        await client.send(Identify())
        blocks = await client.send(GetBlockInfo())
        assert blocks["INENC"].number == CHANNELS, blocks
        fields = await client.send(GetFieldInfo("INENC"))
        assert fields["VAL"].type == "pos_out", fields
        # What `pandablocks save` writes.
        state = await client.send(GetState())
        assert "*METADATA.LABEL_INENC1=EnDat encoder" in state and "INENC1.VAL.UNITS=deg" in state, state


def metadata():
    # The header of an acquisition, as every client sees it.
    with BlockingClient("127.0.0.1") as client:
        data = client.data(scaled=False)
        assert isinstance(next(data), ReadyData)
        client.send(Arm())
        start = next(d for d in data if isinstance(d, StartData))
        units = {field.name: field.units for field in start.fields}
        assert units["INENC1.VAL"] == "deg" and units["PCAP.TS_TRIG"] == "s", units
        assert all(field.scale > 0 for field in start.fields)
        next(d for d in data if isinstance(d, EndData))


def ioc():
    # Ports of its own, so that it meets no other one.
    ports = {"EPICS_CA_SERVER_PORT": "15064", "EPICS_PVA_SERVER_PORT": "15075", "EPICS_PVA_BROADCAST_PORT": "15076"}
    # Its console ends with its input.
    ended = subprocess.run(
        [sys.executable, "-m", "pandablocks_ioc", "softioc", "127.0.0.1", "TEST"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env={**os.environ, **ports},
        timeout=120,
    )
    told = ended.stdout
    assert "iocRun: All initialization complete" in told and "Traceback" not in told, told


def main(program, folder, port, *more):
    card = ["--port", port]
    server = subprocess.Popen(
        [program, "serve", *card, "--samples", str(SAMPLES)], stdout=subprocess.PIPE, text=True
    )
    try:
        for expected in ("control 127.0.0.1:8888", "data 127.0.0.1:8889"):
            line = server.stdout.readline().strip()
            assert line == expected, line
        asyncio.run(introspect())
        metadata()
        if "ioc" in more:
            ioc()
        before = datetime.utcnow()
        scheme = str(Path(folder) / "run-%d.h5")
        subprocess.run(
            ["pandablocks", "hdf", "127.0.0.1", scheme, "--num=2", "--arm"], check=True, timeout=300
        )
    finally:
        server.terminate()
        server.wait()
    for number in (1, 2):
        with h5py.File(scheme % number) as file:
            armed, started = (datetime.fromisoformat(file.attrs[name][:26]) for name in ("arm_time", "start_time"))
            assert before <= armed <= started <= datetime.utcnow(), (before, armed, started)
            trigger = np.array(file["TRIGGER.COUNT.Value"])
            time = np.array(file["PCAP.TS_TRIG.Value"])
            assert len(trigger) == SAMPLES, len(trigger)
            assert (np.diff(trigger) == 1).all(), "a sample is missing"
            assert np.allclose(np.diff(time), 1 / RATE_HZ, atol=1e-7)
            for channel in range(1, CHANNELS + 1):
                angle = np.array(file[f"INENC{channel}.VAL.Value"])
                assert (np.array(file[f"INENC{channel}.FRESH.Value"]) == 1).all()
                assert (np.array(file[f"INENC{channel}.CAUSE.Value"]) == 0).all()
                # Shafts turn slowly, and always on.
                assert (np.diff(angle) > 0).all() and 0 < angle[-1] - angle[0] < 360
    print("PANDA GOOD")


main(*sys.argv[1:])
