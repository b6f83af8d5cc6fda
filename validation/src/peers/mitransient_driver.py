"""Renders with mitransient what `cargo xtask peers` asks for.

Arguments: the scene as JSON (Mitsuba's dictionary, transforms as row-major matrices), the variant,
the number of threads, the samples per pixel of a launch. Then one request per line on standard
input, {"seed": S, "launches": [1, 2, 4], "file": "prefix"}, each answered by one line per entry of
`launches`: the mean of so many launches in an .npz, and the seconds that they took.

Seconds are those in which the launches' kernels run. Off the clock are the start of the interpreter,
the loading of the scene, compilation, the tracing of each launch (these the first line tells),
adding up, and writing files. All launches have the same number of samples,
because another number is another program to compile.
"""

import json
import os
import sys
import time

# Whatever is printed to standard output by others goes to standard error.
ANSWERS = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)


def answer(**values):
    ANSWERS.write(json.dumps(values) + "\n")
    ANSWERS.flush()


class Clock:
    """CPU seconds (user and system, all threads) and wall seconds since its start."""

    def __init__(self):
        self.cpu, self.wall = time.process_time(), time.perf_counter()

    def seconds(self):
        return time.process_time() - self.cpu, time.perf_counter() - self.wall


def load(file, variant, threads):
    import mitsuba as mi

    mi.set_variant(variant)
    mi.set_log_level(mi.LogLevel.Error)
    import drjit as dr
    import mitransient

    dr.set_thread_count(threads)

    def plain(value, key=None):
        if isinstance(value, dict):
            return {k: plain(v, k) for k, v in value.items()}
        if key == "to_world":
            return mi.ScalarTransform4f(value)
        if key == "to_uv":
            # What a plane knows of a map of space: rows and columns x, y and translation.
            return mi.ScalarTransform3f([[row[j] for j in (0, 1, 3)] for row in (value[0], value[1], value[3])])
        return value

    with open(file, encoding="utf-8") as text:
        scene = mi.load_dict(plain(json.load(text)))
    versions = {
        "mitransient": mitransient.__version__,
        "mitsuba": mi.MI_VERSION,
        "drjit": dr.__version__,
        "llvm": ".".join(str(n) for n in dr.detail.llvm_version()),
        "python": sys.version.split()[0],
        "threads": dr.thread_count(),
    }
    return scene, versions


def main():
    file, variant, threads, samples = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    import numpy as np

    scene, versions = load(file, variant, threads)
    import drjit as dr

    load_cpu = time.process_time()

    def launch(seed):
        """The images, CPU and wall seconds of the kernels, CPU seconds before them."""
        tracing = Clock()
        steady, transient = scene.integrator().render(scene, seed=seed % 2**32, spp=samples)
        traced, running = tracing.seconds()[0], Clock()
        dr.eval(steady, transient)
        dr.sync_thread()
        if threads == 1:
            # Without workers, kernels run before `render` returns: tracing cannot be told apart.
            traced, running = 0.0, tracing
        cpu, wall = running.seconds()
        # Channels are averaged, as errors are those of the mean over channels.
        means = [np.array(image).mean(axis=-1, dtype=np.float64) for image in (steady, transient)]
        return means, np.array([cpu, wall, traced])

    # The uppermost seeds: those of requests are below.
    _, first = launch(2**32 - 1)
    _, again = launch(2**32 - 2)
    answer(
        versions=versions,
        load_cpu_seconds=load_cpu,
        compile_cpu_seconds=max(first[0] + first[2] - again[0] - again[2], 0.0),
        trace_cpu_seconds=again[2],
        launch_cpu_seconds=again[0],
    )
    for line in sys.stdin:
        request = json.loads(line)
        steady = transient = seconds = 0.0
        made = 0
        for wanted in request["launches"]:
            while made < wanted:
                (one, bins), passed = launch(request["seed"] + made)
                steady, transient, seconds = steady + one, transient + bins, seconds + passed
                made += 1
            name = f"{request['file']}-{made}.npz"
            np.savez(
                name,
                transient=(transient / made).astype(np.float32),
                steady=(steady / made).astype(np.float32),
            )
            cpu, wall, _ = seconds
            answer(launches=made, cpu_seconds=cpu, wall_seconds=wall, file=name)


main()
