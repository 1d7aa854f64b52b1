#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Counts per query of the suites arms and arms_long, and every number of part 1 of docs/study.md.

    arms.py counts out/arms/results.sqlite | xz -9 > arms.csv.xz
    arms.py tables arms.csv.xz

A line per query and arm: `answer` is c (correct), f (false) or empty; `map` numbers the different maps
of a room; then keyframes of the map, how many are left after equations 3, 4 and 6, and of the
similarities that equation 5 sums: the share that no query computed, the share that an earlier query
left, the share of the sums that the latter are, and how many queries ago they were left (mean).
"""

import collections
import csv
import lzma
import random
import sqlite3
import sys

COLUMNS = "room arm map set frame answer keyframes c1 c2 final unscored stale weight age".split()
SETS = {"held_out": "held out", "second_tour": "second tour"}
PAIRS = [
    ("labels", "released"), ("placebo", "released"), ("labels", "placebo"), ("both", "released"),
    ("words_cleared", "released"), ("labels_cleared", "words_cleared"),
    ("words_fresh", "words_cleared"), ("both_fresh", "words_fresh"),
]
WITHOUT_LABELS = ["released", "placebo", "words_fresh"]  # their slope of success over stale weight
BINS = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
RESAMPLES = 10000


def counts(file):
    """Prints the lines of a results file."""
    store = sqlite3.connect(f"file:{file}?mode=ro", uri=True)
    rows = store.execute(
        "SELECT r.environment, r.system, json_extract(r.result, '$.map_digest'), query_set, frame, correct,"
        " false_positive, keyframes, c1, c2, final, unscored, stale, stale_weight, stale_age"
        " FROM plan p JOIN runs r ON r.key = p.key JOIN queries q ON q.key = r.key"
        " WHERE r.status = 'done' ORDER BY p.position, query_set, frame")
    maps = collections.defaultdict(dict)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(COLUMNS)
    for room, arm, digest, query_set, frame, correct, false, *kept in rows:
        number = maps[room].setdefault(digest, len(maps[room]))
        answer = "c" if correct else "f" if false else ""
        shares = ["" if v is None else f"{v:.4g}" for v in kept[4:]]
        out.writerow([room, arm, number, query_set, frame, answer, *kept[:4], *shares])


def number(text):
    return float(text) if text else None


class Query:
    def __init__(self, row):
        self.success = float(row["answer"] != "")
        self.correct = float(row["answer"] == "c")
        self.map = row["map"]
        for name in COLUMNS[6:]:
            setattr(self, name, number(row[name]))


def read(file):
    """Queries by set, room, frame and arm."""
    queries = {s: collections.defaultdict(lambda: collections.defaultdict(dict)) for s in SETS}
    with (lzma.open(file, "rt") if file.endswith(".xz") else open(file)) as text:
        for row in csv.DictReader(text):
            queries[row["set"]][row["room"]][int(row["frame"])][row["arm"]] = Query(row)
    return queries


def mean(values):
    known = [v for v in values if v is not None]
    return sum(known) / len(known) if known else None


def interval(rooms, statistic):
    """95 % by resampling rooms; statistic(list of rooms) -> number."""
    draw = random.Random(0)
    values = sorted(statistic(draw.choices(rooms, k=len(rooms))) for _ in range(RESAMPLES))
    return values[round(0.025 * (RESAMPLES - 1))], values[round(0.975 * (RESAMPLES - 1))]


def in_points(value, low_high):
    return f"{100 * value:+.1f} ({100 * low_high[0]:+.1f} to {100 * low_high[1]:+.1f})"


def by_room(rooms, arm, value):
    """Mean over the queries of each room, without rooms where it is unknown."""
    means = (mean(value(q[arm]) for q in room.values() if arm in q) for room in rooms.values())
    return [m for m in means if m is not None]


def differences(rooms, a, b, value):
    """Per room."""
    return [mean(value(q[a]) - value(q[b]) for q in room.values()) for room in rooms.values()]


def print_arms(rooms, arms):
    print(f"{'arm':15} success           correct  eq. 3    eq. 4   eq. 6   left  unscored  stale  "
          "of weight   age")
    shown = lambda v, scale=100.0, digits=1: "-" if v is None else f"{scale * v:.{digits}f}"
    for arm in arms:
        success = by_room(rooms, arm, lambda q: q.success)
        low, high = interval(success, mean)
        of = lambda value: mean(by_room(rooms, arm, value))
        share = lambda name: of(lambda q: getattr(q, name) / q.keyframes if q.keyframes else None)
        print(f"{arm:15} {100 * mean(success):4.1f} ({100 * low:4.1f}, {100 * high:4.1f})"
              f"  {shown(of(lambda q: q.correct)):>6}  {shown(share('c1'), digits=2):>6}"
              f"  {shown(share('c2'), digits=2):>6}  {shown(share('final'), digits=2):>6}"
              f"  {shown(of(lambda q: q.final), 1, 2):>5}  {shown(of(lambda q: q.unscored)):>8}"
              f"  {shown(of(lambda q: q.stale)):>5}  {shown(of(lambda q: q.weight)):>9}"
              f"  {shown(of(lambda q: q.age), 1):>4}")


def print_pairs(rooms):
    for a, b in PAIRS:
        cells = []
        for value in (lambda q: q.success, lambda q: q.correct, lambda q: q.weight or 0.0):
            d = differences(rooms, a, b, value)
            cells.append(in_points(mean(d), interval(d, mean)))
        print(f"{a + ' - ' + b:32} {cells[0]:24} correct {cells[1]:24} stale weight {cells[2]}")


def print_bins(rooms, arms):
    """Success over the share of stale weight, pooled queries."""
    names = ["none"] + [f"to {100 * high:.0f} %" for high in BINS[1:]]
    print(f"{'success by stale weight':24}" + "".join(f"{n:>16}" for n in names))
    for arm in arms:
        cells = [[] for _ in names]
        for room in rooms.values():
            for q in (q[arm] for q in room.values()):
                if q.weight is not None:
                    cells[sum(q.weight > edge + 1e-12 for edge in BINS[:-1])].append(q.success)
        print(f"{arm:24}" + "".join(
            f"{f'{100 * mean(c):.1f} ({len(c)})' if c else '-':>16}" for c in cells))


def sums_within(room):
    """Of the arms without labels, within each query: stale weight squared, and times success."""
    xx = xy = 0.0
    for q in room.values():
        known = [q[a] for a in WITHOUT_LABELS if q[a].weight is not None]
        if len(known) > 1:
            x, y = mean(k.weight for k in known), mean(k.success for k in known)
            xx += sum((k.weight - x) ** 2 for k in known)
            xy += sum((k.weight - x) * (k.success - y) for k in known)
    return xx, xy


def print_mediation(rooms):
    """What is left of a difference to `released` if success follows stale weight as without labels."""
    sums = [sums_within(room) for room in rooms.values()]
    slope = lambda s: sum(xy for _, xy in s) / (sum(xx for xx, _ in s) or 1.0)
    low, high = interval(sums, slope)
    print(f"success by stale weight within queries, arms without labels: {slope(sums):+.3f} ({low:+.3f} to {high:+.3f}) per unit")
    for arm in ("labels", "both", "placebo"):
        y = differences(rooms, arm, "released", lambda q: q.success)
        x = differences(rooms, arm, "released", lambda q: q.weight or 0.0)
        units = list(zip(y, x, sums))

        def left(us):
            return mean(u[0] for u in us) - slope([u[2] for u in us]) * mean(u[1] for u in us)

        explained = slope(sums) * mean(x)
        print(f"  {arm + ' - released':20} {100 * mean(y):+.1f} points, {100 * explained:+.1f} by less stale weight, "
              f"left {in_points(left(units), interval(units, left))}")


def print_lost(rooms):
    """Queries that fresh scores answer on the same map, and stale ones do not."""
    for arm in ("released", "placebo", "words_cleared"):
        same = [(q[arm], q["words_fresh"]) for room in rooms.values() for q in room.values()
                if q[arm].map == q["words_fresh"].map]
        lost = [a for a, fresh in same if fresh.success > a.success]
        won = [a for a, fresh in same if fresh.success < a.success]
        weight = lambda qs: f"{100 * (mean(q.weight for q in qs) or 0.0):.1f} %"
        print(f"  {arm:14} {len(same)} queries on the same map: {len(lost)} lost, {len(won)} won by it; stale weight "
              f"{weight(lost)} in those lost, {weight([a for a, _ in same])} in all")


def tables(file):
    for query_set, rooms in read(file).items():
        whole = {r: qs for r, qs in rooms.items() if all(len(q) == len(ARMS) for q in qs.values())}
        if not whole:
            continue
        asked = sum(len(qs) for qs in whole.values())
        print(f"\n== {SETS[query_set]}: {len(whole)} rooms, {asked} queries; means over rooms, %, 95 % intervals")
        print_arms(whole, ARMS)
        print()
        print_pairs(whole)
        print()
        print_bins(whole, ARMS)
        print()
        print_mediation(whole)
        print("lost to scores that are not of this query:")
        print_lost(whole)


ARMS = ["released", "labels", "both", "placebo", "words_cleared", "labels_cleared", "words_fresh", "both_fresh"]

if __name__ == "__main__":
    commands = {"counts": counts, "tables": tables}
    if len(sys.argv) != 3 or sys.argv[1] not in commands:
        sys.exit(__doc__)
    commands[sys.argv[1]](sys.argv[2])
