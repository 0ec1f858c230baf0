#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints the benchmark medians as a table: burin's time, the peer's time, the ratio.

A benchmark burin_X has the peer PEER_X with the same arguments (burin_offset/1/1 and clipper_offset/1/1); there may be several peers."""
import json
import sys

with open(sys.argv[1]) as f:
    report = json.load(f)
medians = {}
for b in report["benchmarks"]:
    if b.get("aggregate_name") != "median":
        continue
    name = b["run_name"]
    unit = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[b["time_unit"]]
    extra = {k: v for k, v in b.items() if k in ("segments", "arcs", "bound_mm", "million_per_s")}
    medians[name] = (b["cpu_time"] * unit, b.get("label", ""), extra)


def figure(value):
    return f"{value:.4g}"


print(f"{'benchmark':42} {'burin ms':>10} {'peer ms':>10} {'peer/burin':>11}  counts (burin | peer)")
for name, (time, label, extra) in medians.items():
    if not name.startswith("burin_"):
        continue
    tail = name[len("burin_"):]
    peers = [n for n in medians if not n.startswith("burin_") and n.split("_", 1)[1] == tail]
    shown = f"{tail} {label}".strip()
    counts = ", ".join(f"{k} {figure(v)}" for k, v in extra.items())
    if not peers:
        print(f"{shown:42} {figure(time):>10} {'-':>10} {'-':>11}  {counts}")
    for peer in peers:
        peer_time, _, peer_extra = medians[peer]
        peer_counts = ", ".join(f"{k} {figure(v)}" for k, v in peer_extra.items())
        print(f"{shown:42} {figure(time):>10} {figure(peer_time):>10} {peer_time / time:>10.1f}x  {counts} | {peer.split('_')[0]} {peer_counts}")
