"""Prints what Python adds to a step and whether create-run-destroy cycles grow. usage: measure.py [CYCLES, default
10000]"""
import ctypes
import gc
import resource
import sys
import time

import drillmbd as mbd


def body_in_space():
    model = mbd.Model()
    model.set_environment(gravity=(0, 0, 0))
    body = model.add_body(mass=1.0)
    model.compile()
    return model, body


def median(function, repeat=20000, rounds=7):
    """[us] of the processor for one call, whatever else runs"""
    found = []
    for _ in range(rounds):
        begin = time.process_time()
        for _ in range(repeat):
            function()
        found.append(1e6 * (time.process_time() - begin) / repeat)
    return sorted(found)[rounds // 2]


def overhead():
    model, body = body_in_space()
    with model.sim(energy_ledger=0) as sim:
        place, handle, function = mbd.station(body), sim._handle, mbd._lib.dmb_sim_step
        bare = median(lambda: function(handle, ctypes.c_double(1e-3), None))
        step = median(lambda: sim.step(1e-3))
        pose = median(lambda: sim.pose(place))
    print(f"step of one body: {step:.2f} us, the bare call {bare:.2f} us, so Python's part {step - bare:.2f} us; "
          f"a query of a pose {pose:.2f} us")


def growth(cycles):
    def cycle():
        model = mbd.Model()
        model.add_drive(part=model.add_pipes(2), time_function=model.add_time_function(lambda time: 0.05 * time))
        model.compile()
        with model.sim() as sim:
            sim.step(1e-3)

    for _ in range(200):
        cycle()
    gc.collect()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(cycles):
        cycle()
    print(f"{cycles} cycles: peak memory {before} KiB before, "
          f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss} KiB after")


overhead()
growth(int(sys.argv[1]) if len(sys.argv) > 1 else 10000)
