"""Spreads videos over processes of this machine, or over a Dask cluster that runs already."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool

from runtime.cater.evaluation import Job, VideoResult, evaluate_videos
from runtime.errors import UsageError

_LARGEST_BATCH = 8
"""Videos. Small enough for a bar that moves and for little to be lost, large enough to be worth
sending."""

_CONNECT_TIMEOUT_S = 10


def usable_cores() -> int:
    """Give the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def evaluate_on_cores(
    job: Job, videos: Sequence[str], processes: int
) -> Iterator[tuple[VideoResult, ...]]:
    """Evaluate videos on this machine, and give the results batch by batch, as they come.

    Args:
        job: What is evaluated.
        videos: The videos' names.
        processes: How many work at a time; 1 works in this process.

    Raises:
        AnchoringError: A model failed.
        DomainError: The domain cannot be loaded.
        UsageError: A worker process was ended from outside.
    """
    batches = _batches(videos, processes)
    if processes == 1 or len(batches) == 1:
        for batch in batches:
            yield evaluate_videos(job, batch)
        return
    # Not forked: the threads of numerical libraries do not survive that everywhere.
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(processes, len(batches)), mp_context=context) as pool:
        futures = [pool.submit(evaluate_videos, job, batch) for batch in batches]
        try:
            for future in as_completed(futures):
                yield future.result()
        except BrokenProcessPool as error:
            raise UsageError(
                "a worker process ended unexpectedly, perhaps for want of memory; "
                "with fewer --jobs the evaluation goes on where it stopped"
            ) from error
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def evaluate_on_cluster(
    job: Job, videos: Sequence[str], address: str
) -> Iterator[tuple[VideoResult, ...]]:
    """Evaluate videos on a Dask cluster; its workers need this package, and the data in place.

    Args:
        job: What is evaluated; its paths have to mean the same to the workers.
        videos: The videos' names.
        address: The scheduler, such as "tcp://10.0.0.5:8786".

    Raises:
        AnchoringError: A model failed.
        DomainError: The domain cannot be loaded.
        UsageError: Dask is not installed, there is no scheduler at the address, it has no
            workers, or they cannot run this program.
    """
    try:
        from distributed import Client, KilledWorker, as_completed  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise UsageError(
            "--scheduler needs Dask, which is not installed: pip install 'icarus-lite[cluster]'"
        ) from error
    try:
        client = Client(  # type: ignore[no-untyped-call]
            address, timeout=_CONNECT_TIMEOUT_S, set_as_default=False
        )
    except (OSError, ValueError) as error:
        raise UsageError(f"there is no Dask scheduler at {address} ({error})") from error
    with client:
        workers = sum(client.nthreads().values())  # type: ignore[no-untyped-call]
        if not workers:
            raise UsageError(f"the Dask scheduler at {address} has no workers")
        futures = [
            # Not pure: what is in the files counts, which the scheduler cannot see.
            client.submit(evaluate_videos, job, batch, pure=False)
            for batch in _batches(videos, workers)
        ]
        try:
            for future in as_completed(futures, loop=client.loop):  # type: ignore[no-untyped-call]
                yield future.result()
        except (ImportError, KilledWorker, OSError) as error:
            raise UsageError(
                f"the Dask workers at {address} cannot do it: {error}; "
                "each needs icarus-lite in this version"
            ) from error


def _batches(videos: Sequence[str], workers: int) -> list[tuple[str, ...]]:
    # A few for each worker even where there are few videos, so that none waits for long.
    size = max(1, min(_LARGEST_BATCH, len(videos) // (4 * workers)))
    return [tuple(videos[i : i + size]) for i in range(0, len(videos), size)]
