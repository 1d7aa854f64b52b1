# SPDX-License-Identifier: Apache-2.0
"""Where the tests find built and shipped files."""
import os
import pathlib

ROOT = str(pathlib.Path(__file__).resolve().parents[2])
ROOM = ROOT + "/bench/scenarios/room.yaml"
PROGRAM = os.environ["MODELHOUSE"]
CACHE = os.environ["MH_TEST_CACHE"]  # baked light is shared by all tests
