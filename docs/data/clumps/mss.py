"""Clumps of the paper's round tablet by MSS (Buchele, Poeschel and Mueller 2026, Powder Technol., 122635; `pip install
multisphere==1.1.1`), x y z r in mm. Of the settings tried the one with the least mean deviation is kept for each count.

    pancoat shape round --set shapes.round.panels=6000 --out shapes
    python docs/data/clumps/mss.py shapes/round.stl docs/data/clumps
"""
import sys
import time

import multisphere
import numpy as np
import trimesh

mesh = trimesh.load(sys.argv[1])
points, areas = mesh.triangles_center, mesh.area_faces
for count in (20, 50, 100):
    best = np.inf
    for distance in (4, 8, 12, 16, 24):
        begun = time.process_time()
        pack = multisphere.multisphere_from_mesh(
            mesh, div=100, max_spheres=count, min_center_distance_vox=distance
        )
        cpu = time.process_time() - begun
        centers, radii = np.asarray(pack.centers), np.asarray(pack.radii)
        gaps = np.min(np.linalg.norm(points[:, None] - centers[None], axis=2) - radii, axis=1)
        mean = (np.abs(gaps) * areas).sum() / areas.sum()
        print(count, distance, len(radii), f"mean {mean:.3f} largest {np.abs(gaps).max():.3f} mm, {cpu:.1f} s")
        if len(radii) == count and mean < best:
            best = mean
            np.savetxt(f"{sys.argv[2]}/mss_{count}.txt", np.c_[centers, radii], fmt="%.6f")
