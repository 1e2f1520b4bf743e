"""Every texture parameter of one 2048 x 2048 map in gearcut and in surfalize, one after the other in the same run."""

import json
import os
import subprocess
import tempfile
import time
import warnings

import numpy as np

warnings.simplefilter("ignore")
import surfalize  # noqa: E402

FAMILIES = {
    "height": ["Sa", "Sq", "Ssk", "Sku", "Sp", "Sv", "Sz"],
    "hybrid": ["Sdq", "Sdr"],
    "ratio": ["Smc", "Sxp"],
    "core": ["Sk", "Spk", "Svk", "Smr1", "Smr2"],
    "volume": ["Vmp", "Vmc", "Vvv", "Vvc"],
    "spatial": ["Sal", "Str", "Std"],
    "feature": ["Spd", "Spc", "S10z", "S5p", "S5v"],
}
ARGUMENTS = {"Smc": (10,)}
ROUNDS = 2


def main():
    folder = tempfile.mkdtemp(prefix="gearcut_texture_")
    path = os.path.join(folder, "map.npy")
    command = ["cargo", "bench", "--quiet", "--bench", "texture", "--", "--json", "--map", path]
    ours = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)
    z = np.load(path)
    print(f"full set in gearcut: {ours['all']:.0f} ms")
    print(f"{'parameter':10s} {'gearcut ms':>11s} {'surfalize ms':>13s} {'ratio':>7s}")
    slower = []
    for family, symbols in FAMILIES.items():
        for symbol in symbols:
            best = None
            for _ in range(ROUNDS):
                surface = surfalize.Surface(z.copy(), 1.0, 1.0)  # fresh: nothing cached
                start = time.perf_counter()
                try:
                    getattr(surface, symbol)(*ARGUMENTS.get(symbol, ()))
                except Exception as problem:  # a parameter it does not have, or refuses
                    print(f"{symbol:10s} {ours[family]:11.1f}   {type(problem).__name__}: {problem}")
                    break
                taken = 1e3 * (time.perf_counter() - start)
                best = taken if best is None else min(best, taken)
            if best is not None:
                print(f"{symbol:10s} {ours[family]:11.1f} {best:13.1f} {best / ours[family]:7.1f}")
                if best < ours[family]:
                    slower.append(symbol)
    print("slower than surfalize:", ", ".join(slower) if slower else "none")


if __name__ == "__main__":
    main()
