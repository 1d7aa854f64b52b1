#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads a bag with python3-rosbag, decodes every message using the definition in the bag and
prints what it found; exit code 77 if the library is missing. Usage: read_bag.py FILE"""
import json
import sys

try:
    import genpy.dynamic
    import rosbag
except ImportError:
    sys.exit(77)

topics = {}
with rosbag.Bag(sys.argv[1]) as bag:
    for connection in bag._get_connections():
        # The checksum of the definition must be the one in the bag.
        generated = genpy.dynamic.generate_dynamic(connection.datatype, connection.msg_def)
        if generated[connection.datatype]._md5sum != connection.md5sum:
            sys.exit(f"{connection.datatype}: md5 is {generated[connection.datatype]._md5sum}")
    for topic, message, _ in bag.read_messages():
        entry = topics.setdefault(
            topic, {"type": message._type, "count": 0, "stamps": [], "frames": [], "bytes": 0})
        header = getattr(message, "header", None)
        if header is None and getattr(message, "transforms", None):
            header = message.transforms[0].header
        if header is not None:
            entry["stamps"].append(str(header.stamp.to_nsec()))
            if header.frame_id not in entry["frames"]:
                entry["frames"].append(header.frame_id)
        entry["count"] += 1
        if hasattr(message, "data") and hasattr(message.data, "__len__"):
            entry["bytes"] += len(message.data)
    messages = bag.get_message_count()
print(json.dumps({"messages": messages, "topics": topics}))
