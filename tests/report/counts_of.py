#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
#
# counts_of.py REPORT.json: the numbers of count.py as the report's first mesh has them.
import json
import sys

mesh = json.load(open(sys.argv[1], encoding='utf-8'))['files'][0]['meshes'][0]
t, e = mesh['triangles'], mesh['edges']
print(t['normal'], t['mirrored'], t['degenerate'], e['all'], e['boundary'], e['non_manifold'],
      e['inconsistent_winding'], e['mirror'], sum(mesh['islands_by_kind'].values()))
