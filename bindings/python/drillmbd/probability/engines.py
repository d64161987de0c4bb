"""Engines: where samples are computed. Each takes the sample function and tasks (number, z), and gives results as they
come. A result depends on its number and z alone, so all engines give the same."""
from __future__ import annotations

import collections
import contextlib
import math
import multiprocessing
import multiprocessing.connection
import os
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from .._optional import need
from .._progress import INTERRUPTS
from ..errors import Usage
from .sample import FAILED, Result

TRIES = 3  #: workers that a sample may kill before it counts as failed
AHEAD = 4  #: tasks that wait for each worker
PATIENCE = 5.0  #: [s] for a worker to end by itself
LOOK = 1.0      #: [s] between looks for Ctrl-C
SUBMISSIONS = 3  #: of a sample to a Dask cluster that loses it


def lost(sample: Any, task: tuple[int, Any], message: str) -> Any:
    """The result of a task that no worker could compute: of its sample, or a list of those of its samples (Blocks)."""
    number, z = task
    if isinstance(z, list):
        return [lost(sample, one, message) for one in z]
    count = len(sample.names)
    return Result(number, FAILED, [math.nan] * count, [math.nan] * count, [math.nan] * len(sample.inputs), 0.0, message)


def serial(sample: Any, tasks: Iterable[tuple[int, Any]]) -> Iterator[Result]:
    """One after the other."""
    for number, z in tasks:
        yield sample(number, z)


# ---- Threads ---------------------------------------------------------------------------------------------------------
def threads(workers: int) -> Callable[..., Iterator[Result]]:
    """In threads of this process: the library runs without Python's lock, Python itself does not."""
    from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait

    def run(sample: Any, tasks: Iterable[tuple[int, Any]]) -> Iterator[Result]:
        sample.names  # made once, before the threads use it
        pool, waiting = ThreadPoolExecutor(workers), set[Any]()
        try:
            source = iter(tasks)
            for task in source:
                waiting.add(pool.submit(sample, *task))
                if len(waiting) < workers * AHEAD:
                    continue
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                yield from (one.result() for one in done)
            for one in waiting:
                yield one.result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
    return run


# ---- Processes -------------------------------------------------------------------------------------------------------
def _work(sample: Any, pipe: Any, others: list[Any]) -> None:
    import signal
    # the parent's ends, which a fork copies: with them open nobody would notice that the parent is gone
    for one in others:
        one.close()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's
    while True:
        try:
            task = pipe.recv()
        except EOFError:
            return
        if task is None:
            return
        found = sample(*task)
        try:
            pipe.send(found)
        except OSError:
            return


class _Worker:
    """A process, its pipe and the task that it has."""

    def __init__(self, context: Any, sample: Any, team: list[_Worker]) -> None:
        self.pipe, other = context.Pipe()
        others = [self.pipe, *(one.pipe for one in team)] if context.get_start_method() == "fork" else []
        self.process = context.Process(target=_work, args=(sample, other, others), daemon=True)
        self.process.start()
        other.close()
        self.task: Any = None

    def give(self, task: Any) -> None:
        self.task = task
        try:
            self.pipe.send(task)
        except OSError:
            pass  # it is dead, which the next look tells

    def end(self, patience: float = PATIENCE) -> None:
        """Ends the process: in `patience` [s] by itself, else by force."""
        try:
            self.pipe.send(None)
        except OSError:
            pass
        self.pipe.close()
        self.process.join(patience)
        if self.process.is_alive():
            self.process.kill()
            self.process.join()


def processes(workers: int) -> Callable[..., Iterator[Result]]:
    """In processes. One that dies is replaced, and its sample begun again; a sample that kills TRIES of them has
    failed."""
    def run(sample: Any, tasks: Iterable[tuple[int, Any]]) -> Iterator[Result]:
        sample.names  # made here, so that forked workers need not
        context = multiprocessing.get_context("fork" if "fork" in multiprocessing.get_all_start_methods() else None)
        source, again = iter(tasks), collections.deque[Any]()
        kills: dict[int, int] = {}
        team: list[_Worker] = []
        patience = 0.0

        def following() -> Any:
            return again.popleft() if again else next(source, None)
        try:
            task = following()
            while task is not None and len(team) < workers:
                team.append(_Worker(context, sample, team))
                team[-1].give(task)
                task = following() if len(team) < workers else None
            while any(one.task is not None for one in team):
                busy = [one for one in team if one.task is not None]
                ready = multiprocessing.connection.wait([one.pipe for one in busy], LOOK)
                INTERRUPTS.check()
                for i, one in enumerate(team):
                    if one.task is None or one.pipe not in ready:
                        continue
                    (number, z), one.task = one.task, None
                    try:
                        found = one.pipe.recv()
                    except (EOFError, OSError):
                        one.process.join()
                        told, found = f"its worker died ({_cause(one.process.exitcode)})", None
                        one.end()
                        one = team[i] = _Worker(context, sample, [other for other in team if other is not one])
                        kills[number] = kills.get(number, 0) + 1
                        if kills[number] < TRIES:
                            again.append((number, z))
                        else:
                            found = lost(sample, (number, z), f"{told}, {TRIES} times")
                    task = following()
                    if task is not None:
                        one.give(task)
                    if found is not None:
                        yield found
                for one in team:  # a worker may have been idle when a dead one's sample came back
                    if one.task is None and again:
                        one.give(again.popleft())
            patience = PATIENCE
        finally:
            for one in team:
                one.end(patience)
    return run


def _cause(status: int | None) -> str:
    import signal
    if status is None or status >= 0:
        return f"exit status {status}"
    try:
        return f"signal {signal.Signals(-status).name}"
    except ValueError:  # a real-time signal between SIGRTMIN and SIGRTMAX has no name
        return f"signal {-status}"


# ---- MPI -------------------------------------------------------------------------------------------------------------
_TASK, _END = 1, 2


def mpi_rank() -> tuple[int, int]:
    """Rank and size of this process in MPI's world."""
    world = need("mpi4py.MPI").COMM_WORLD
    return int(world.Get_rank()), int(world.Get_size())


@contextlib.contextmanager
def mpi_together() -> Iterator[None]:
    """An unexpected exception ends all ranks with its message: the others would wait for this one for ever."""
    try:
        yield
    except (Exception, KeyboardInterrupt) as error:
        from ..exit_status import FAILED as STATUS
        from ..exit_status import status_and_message
        rank, message = mpi_rank()[0], status_and_message(error)
        if message is None:
            traceback.print_exc()
        print(f"drillmbd: rank {rank} of {mpi_rank()[1]} failed, all are ended: "
              f"{message[1] if message else f'{type(error).__name__}: {error}'}",
              file=sys.stderr, flush=True)
        need("mpi4py.MPI").COMM_WORLD.Abort(message[0] if message else STATUS)
        raise


def mpi_work(sample: Any) -> None:
    """Ranks above 0 compute samples until rank 0 ends them."""
    mpi = need("mpi4py.MPI")
    world, status = mpi.COMM_WORLD, mpi.Status()
    while True:
        task = world.recv(source=0, status=status)
        if status.Get_tag() == _END:
            return
        number, z = task
        world.send(sample.many(z) if isinstance(z, list) else sample(number, z), dest=0)


def mpi(sample: Any, tasks: Iterable[tuple[int, Any]]) -> Iterator[Result]:
    """On the ranks above 0, which are in mpi_work. Call mpi_end when no more tasks come."""
    module = need("mpi4py.MPI")
    world, status = module.COMM_WORLD, module.Status()
    if world.Get_size() < 2:
        raise RuntimeError("the engine mpi needs two ranks or more: mpirun -n 3 drillmbd probability ... --engine mpi")
    source, free, busy = iter(tasks), list(range(1, world.Get_size())), 0
    while True:
        while free:
            task = next(source, None)
            if task is None:
                break
            world.send(task, dest=free.pop(0), tag=_TASK)
            busy += 1
        if not busy:
            return
        found = world.recv(source=module.ANY_SOURCE, status=status)
        free.append(status.Get_source())
        busy -= 1
        yield found


def mpi_end() -> None:
    """Lets the ranks above 0 go."""
    world = need("mpi4py.MPI").COMM_WORLD
    for rank in range(1, world.Get_size()):
        world.send(None, dest=rank, tag=_END)


# ---- Dask ------------------------------------------------------------------------------------------------------------
def dask(workers: int, address: str | None = None) -> Callable[..., Iterator[Result]]:
    """On a Dask cluster, or without an address on one of processes of this machine. Dask begins the samples of a dead
    worker again; a sample that ends for another reason than its own, for example because the worker that held it was
    lost, is submitted again."""
    def run(sample: Any, tasks: Iterable[tuple[int, Any]]) -> Iterator[Result]:
        distributed = need("distributed")
        if address is None:
            client = distributed.Client(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None,
                                        local_directory=os.environ.get("TMPDIR", "/tmp"))
        else:
            try:
                client = distributed.Client(address)
            except (ValueError, OSError) as error:
                raise Usage(f"--address {address}: {error}; write HOST:PORT of a scheduler") from error
        with client:
            shared = client.scatter(sample, broadcast=True)
            # task and its number of submissions
            source, running = iter(tasks), dict[Any, tuple[tuple[int, Any], int]]()
            coming = distributed.as_completed()

            def give(task: tuple[int, Any] | None, times: int) -> None:
                # again: with the sample itself, because the shared one may be lost with its worker
                if task is not None:
                    future = client.submit(_call, shared if times == 1 else sample, *task, pure=False)
                    running[future.key] = (task, times)
                    coming.add(future)
            for _ in range(workers * AHEAD):
                give(next(source, None), 1)
            for future in coming:
                task, times = running.pop(future.key)
                found, reason = _outcome(future)
                if found is None:
                    future.release()
                    if times < SUBMISSIONS and not isinstance(reason, distributed.KilledWorker):
                        give(task, times + 1)
                        continue
                    found = lost(sample, task, f"its worker died: {reason or future.status}")
                future.release()
                give(next(source, None), 1)
                yield found
    return run


def _outcome(future: Any) -> tuple[Any, Any]:
    """Result and reason of its lack. The worker that holds a finished result may be lost before it is fetched."""
    if future.status in ("cancelled", "lost"):
        return None, None
    try:
        return future.result(), None
    except Exception as error:  # of the sample, or of the cluster
        return None, error


def _call(sample: Any, number: int, z: Any) -> Any:
    return sample(number, z)


NAMES = ("serial", "threads", "processes", "mpi", "dask")


def engine(name: str, workers: int | None = None, address: str | None = None) -> Any:
    """An engine by its name; workers: by default the number of processors."""
    count = workers or len(os.sched_getaffinity(0))
    if name == "threads":
        return threads(count)
    if name == "processes":
        return processes(count)
    if name == "dask":
        return dask(count, address)
    return {"serial": serial, "mpi": mpi}[name]
