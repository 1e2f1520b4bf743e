"""A study on the workers of a Dask scheduler, a share each time: workers that are lost lose no finished case.

    python studies/cluster/dask_client.py tcp://scheduler:8786 studies/finishing_feed.toml 64

Workers have the Python package, and a folder that all of them share. With one thread each (``--nthreads 1``) a worker
makes one share after the other, on as many cores as RAYON_NUM_THREADS says.
"""

import sys
from pathlib import Path

from dask.distributed import Client, as_completed

import gearcut


def share(study: str, number: int, shares: int) -> str:
    """Makes what is missing of a share."""
    return str(gearcut.study(study, shard=(number, shares)))


def main(scheduler: str, study: str, shares: int) -> None:
    with Client(scheduler) as client:
        futures = client.map(share, [study] * shares, range(1, shares + 1), [shares] * shares, pure=False, retries=10)
        for done, future in enumerate(as_completed(futures), 1):
            print(f"{done} of {shares}: {future.result()}", flush=True)
    rows = gearcut.read_study(Path("out") / f"{Path(study).stem}_study")
    print(f"{rows.rows} rows")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
