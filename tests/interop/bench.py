"""Every texture parameter of one 2048 x 2048 map in gearcut and in surfalize, one after the other in the same run.

What is timed is one parameter alone, from the heights in memory: centring, sorting, transforms and segmentation
included, nothing kept from another parameter. gearcut's families share that work, so that all parameters of a family
cost alike.
"""

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
    "gradient": ["Sdq"],
    "area": ["Sdr"],
    "ratio": ["Smr"],
    "height at a ratio": ["Smc"],
    "heights at two": ["Sdc", "Sxp"],
    "core": ["Sk", "Spk", "Svk", "Smrk1", "Smrk2", "Spkx", "Svkx", "Sak1", "Sak2"],
    "volume": ["Vm", "Vv", "Vmp", "Vmc", "Vvc", "Vvv"],
    "correlation": ["Sal", "Str"],
    "direction": ["Std"],
    "wavelength": ["Ssw"],
    "feature": ["Spd", "Spc", "Sha", "Svd", "Svc", "Sda", "S10z", "S5p", "S5v"],
}
ARGUMENTS = {"Smr": (0.0,), "Smc": (10,), "Sdc": (10, 80), "Vm": (10,), "Vv": (10,)}
ROUNDS = 3


def main():
    with tempfile.TemporaryDirectory(prefix="gearcut_texture_") as folder:
        path = os.path.join(folder, "map.npy")
        bench = ["cargo", "bench", "--quiet", "-p", "gearcut-texture", "--bench", "texture"]
        command = [*bench, "--", "--json", "--map", path]
        ours = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)
        z = np.load(path)
    peer = f"surfalize {surfalize.__version__}"
    print(f"full set in gearcut: {ours['all']:.0f} ms; {peer}; load {os.getloadavg()[0]:.1f}")
    print("| parameter | gearcut, ms | surfalize, ms | ratio |")
    print("| --- | --- | --- | --- |")
    slower, whole = [], 0.0
    for family, symbols in FAMILIES.items():
        for symbol in symbols:
            best = min(time_ms(z, symbol) for _ in range(ROUNDS))
            whole += best
            print(f"| {symbol} | {ours[family]:.1f} | {best:.1f} | {best / ours[family]:.1f} |", flush=True)
            if best < ours[family]:
                slower.append(symbol)
    print(f"all of them one by one in surfalize: {whole:.0f} ms")
    print("slower than surfalize:", ", ".join(slower) if slower else "none")


def time_ms(z, symbol):
    surface = surfalize.Surface(z.copy(), 1.0, 1.0)  # fresh: nothing cached
    start = time.perf_counter()
    getattr(surface, symbol)(*ARGUMENTS.get(symbol, ()))
    return 1e3 * (time.perf_counter() - start)


if __name__ == "__main__":
    main()
