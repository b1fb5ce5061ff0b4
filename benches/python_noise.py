"""How fast `jaspe.noise` is next to other packages for Python: `python benches/python_noise.py [POINTS]`, with the packages that it is to be
compared with installed beside `jaspe` (noise, opensimplex with numba, pyfastnoisesimd; those that are missing are left out).

Gradient noise of one octave in three dimensions at 16 million points (a grid of 256³ with a step of 0.02, since some of the packages
take nothing else), in the fastest way that each package has. In one process, in turn; the table has medians of five, and the ratio to
Jaspe of the same turn.
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from typing import Callable

import numpy as np

from jaspe import noise

#: (pyfastnoisesimd wants a multiple of its vectors.)
SIDE = 16 * round((int(sys.argv[1]) if len(sys.argv) > 1 else 256**3) ** (1 / 3) / 16)
STEP = 0.02
ROUNDS = 5


def axis() -> np.ndarray:
    return np.arange(SIDE, dtype=np.float32) * np.float32(STEP)


def contestants() -> dict[str, tuple[Callable[[], object], float]]:
    """What is measured: name, function, and the part of the points that it evaluates."""
    x, y, z = np.meshgrid(axis(), axis(), axis(), indexing="ij")
    points = np.stack((x, y, z), axis=-1)
    columns = np.stack((x, y, z)).transpose(1, 2, 3, 0)
    del x, y, z
    grid = noise.Grid(axis(), axis(), axis())
    found: dict[str, tuple[Callable[[], object], float]] = {
        "jaspe.noise.perlin(points)": (lambda: noise.perlin(points), 1.0),
        "the same, coordinates in planes": (lambda: noise.perlin(columns), 1.0),
        "jaspe.noise.perlin(Grid(x, y, z))": (lambda: noise.perlin(grid), 1.0),
        "jaspe.noise.simplex(points)": (lambda: noise.simplex(points), 1.0),
    }
    try:
        import noise as caseman

        # A thousandth: a call for each point.
        few = points.reshape(-1, 3)[::1000].astype(float).tolist()
        pnoise3 = caseman.pnoise3
        found["noise: pnoise3, a call for each point"] = (
            lambda: np.fromiter((pnoise3(x, y, z) for x, y, z in few), np.float32, len(few)),
            len(few) * 1.0 / SIDE**3,
        )
    except ImportError:
        pass
    try:
        import opensimplex

        along = axis().astype(float)
        opensimplex.seed(1)
        opensimplex.noise3array(along[:2], along[:2], along[:2])
        part = max(1, SIDE // 16)
        found["opensimplex: noise3array, with numba"] = (
            lambda: opensimplex.noise3array(along, along, along[:part]),
            part / SIDE,
        )
    except ImportError:
        pass
    try:
        import pyfastnoisesimd as simd

        perlin = simd.Noise(seed=1, numWorkers=os.cpu_count())
        perlin.noiseType = simd.NoiseType.Perlin
        perlin.frequency = STEP
        found["pyfastnoisesimd: genAsGrid"] = (lambda: perlin.genAsGrid([SIDE, SIDE, SIDE]), 1.0)
        scattered = simd.empty_coords(SIDE**3)
        scattered[:, : SIDE**3] = points.reshape(-1, 3).T / STEP
        found["pyfastnoisesimd: genFromCoords"] = (lambda: perlin.genFromCoords(scattered), 1.0)
    except ImportError:
        pass
    return found


def main() -> None:
    times: dict[str, list[float]] = {}
    ratios: dict[str, list[float]] = {}
    # The time of all cores together, which neighbours on the machine disturb less.
    cores: dict[str, list[float]] = {}
    all_of_them = contestants()
    for turn in range(ROUNDS + 1):
        first = 0.0
        for name, (run, part) in all_of_them.items():
            started, cpu = time.perf_counter(), time.process_time()
            run()
            seconds, cpu = (time.perf_counter() - started) / part, (time.process_time() - cpu) / part
            first = first or seconds
            # The first turn wakes threads and compilers.
            if turn:
                times.setdefault(name, []).append(seconds)
                ratios.setdefault(name, []).append(seconds / first)
                cores.setdefault(name, []).append(cpu)
    print(f"{SIDE**3 / 1e6:.1f} million points, {os.cpu_count()} cores\n")
    print("| | seconds | ns per point | times as long | ns of all cores per point |\n|---|---|---|---|---|")
    for name, seconds in times.items():
        median = statistics.median(seconds)
        print(f"| {name} | {median:.3f} | {1e9 * median / SIDE**3:.2f} | {statistics.median(ratios[name]):.2f} | "
              f"{1e9 * statistics.median(cores[name]) / SIDE**3:.2f} |")


if __name__ == "__main__":
    main()
