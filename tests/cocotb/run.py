"""Runs a test on the Verilog in the current folder: run.py TEST TOP HASH [LANGUAGE [NAME=VALUE ...]]; values go to its environment."""

import sys
from pathlib import Path

from cocotb_tools.runner import get_results, get_runner

test, top, configuration_hash, *more = sys.argv[1:]
language, *settings = more or ["-g2005"]
runner = get_runner("icarus")
runner.build(
    sources=sorted(Path(".").glob("*.v")),
    hdl_toplevel=top,
    build_dir="build",
    build_args=[language],
    timescale=("1ns", "1ps"),
)
results = runner.test(
    hdl_toplevel=top,
    test_module=f"test_{test}",
    test_dir=str(Path(__file__).parent),
    build_dir="build",
    results_xml=str(Path("results.xml").resolve()),
    extra_env={
        "CONFIGURATION_HASH": configuration_hash,
        "PYTHONDONTWRITEBYTECODE": "1",
        **dict(setting.split("=") for setting in settings),
    },
    timescale=("1ns", "1ps"),
)
tests, failed = get_results(results)
print(f"{tests} tests, {failed} failed")
sys.exit(0 if tests > 0 and failed == 0 else 1)
