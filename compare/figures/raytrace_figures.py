"""Defines the figures of raytrace/measurements.md."""
from catalog import figure, ms, number, scene, stem, table


def cover_seconds(run, threads):
    """Returns the render seconds and the million rays per second of the cover scene."""
    data = run("raytrace", scene("spheres"), "--size", "1920x1080", "--spp", 100, "--depth", 50, "--threads", threads,
               "--quiet", output=".png").data
    rays, seconds = data["rays"], data["seconds"]["render"]
    return seconds, (rays["camera"] + rays["indirect"]) / seconds / 1e6


BOOK_SECONDS = 698  # 6.98 s for one sample per pixel, times 100


@figure("cover", 1)
def cover(run):
    """the cover scene of Ray Tracing in One Weekend; the book's program is quoted"""
    rows = []
    for label, threads in (("Duet, two threads", 2), ("Duet, one thread", 1)):
        seconds, rate = cover_seconds(run, threads)
        rows.append([label, number(seconds, 3), number(rate), number(BOOK_SECONDS / seconds)])
    quoted = "quoted: 2026-11-22, a Xeon with AVX-512 at about 3.7 GHz, extrapolated from one sample per pixel"
    rows += [[f"the book's own program, one thread by design ({quoted})", BOOK_SECONDS, "0.79", ""],
             ["the same with book 2's bounding volume hierarchy (quoted likewise)", "235", "2.36", ""]]
    return table(["", "seconds", "million rays per second", "the book's time over it"], rows)


PATH = ("path", "sobol")
TECHNIQUES = (("light samples (`--integrator naive`)", PATH, ("naive", "sobol")),
              ("Sobol points, by `--sampler independent`", PATH, ("path", "independent")),
              ("Sobol points, by `--sampler stratified`", PATH, ("path", "stratified")),
              ("Russian roulette (none)", PATH, ("no-roulette", "sobol")),
              ("`--adaptive`, by even samples", ("adaptive", "sobol"), PATH))


def efficiency_ratio(rows, ours, other, key):
    """Returns the efficiency of a technique and sampler over that of another, or None if one was not measured."""
    found = {(row["technique"], row["sampler"]): row[key]["value"] for row in rows if row["counted"]}
    return found[ours] / found[other] if found.get(ours) and found.get(other) else None


@figure("techniques", 2)
def techniques(run):
    """what each technique gains at equal time"""
    scenes = ("cornell-35", "everything", "lanterns", "veach", "glass")
    results = run("compare", "bench", *map(scene, scenes), "--techniques", "path,adaptive,no-roulette,naive",
                  "--spp", 32, "--repeats", 6, "--size", "96x72", "--threads", 1).data["scenes"]
    rows = [[label] + [" / ".join(number(efficiency_ratio(result["rows"], ours, other, key))
                                  for key in ("relmse_efficiency", "efficiency")) for result in results]
            for label, ours, other in TECHNIQUES]
    return table(["left out or replaced"] + [f"`{name}`" for name in scenes], rows)


def beside_cycles(run, name, spp, seconds, reference, *more, techniques="path,adaptive"):
    return run("compare", "bench", scene(name), "--techniques", techniques, "--samplers", "sobol", "--spp", spp,
               "--repeats", 2, "--size", "256x256", "--peer", "cycles", "--at-seconds", seconds, "--reference-spp",
               reference, "--check-spp", 64, *more, output="")


def cornell_bench(run):
    return beside_cycles(run, "cornell-35", "8,32,128,512,2048", "1,4", 2048, "--exclude", "0.43,0.25,0.57,0.295")


def to_peer(result, technique, at):
    """Returns our squared error over Cycles' after so many seconds."""
    return next((row["to_peer"]["value"] for row in result["equal_times"]
                 if row["name"].startswith(technique) and row["seconds"] == at and row["to_peer"]), None)


@figure("cornell", 3)
def cornell(run):
    """the Cornell box beside Cycles, with a plot; other renderers are quoted"""
    bench = cornell_bench(run)
    result = bench.data["scenes"][0]
    rows = [[f"`{row['technique']}` `{row['sampler']}`", row["spp"], number(row["seconds"]["value"], 3),
             number(row["mse"]["value"]), number(row["rest"]["mse"]["value"]), number(row["relmse"]["value"])]
            for row in result["rows"]]
    ratios = [[technique] + [number(to_peer(result, technique, at)) for at in (1, 4)]
              for technique in ("path", "adaptive")]
    quoted = [["Tungsten, Sobol points", "0.0052", "0.00042", "2.7"],
              ["pbrt-v4, `zsobol` sampler", "0.0061", "0.00093", "0.95"]]
    plot = (run.source / bench.output / "cornell-35.svg").read_text(encoding="utf-8")
    return (table(["", "samples", "seconds", "MSE", "MSE without the light", "relMSE"], rows)
            + "\n\nSquared error over that of Cycles at equal time:\n\n" + table(["", "after 1 s", "after 4 s"], ratios)
            + "\n\n![Relative squared error over seconds of the Cornell box: Duet's curves lie below that of Cycles]"
            "(gallery/cornell-cycles.svg)\n\nOther renderers at 64 samples, quoted: 2026-11-22, two threads of a Xeon, "
            "each against its own mean of 4,096 samples.\n\n"
            + table(["renderer", "RMSE", "relMSE", "million samples per second"], quoted),
            {"gallery/cornell-cycles.svg": plot})


@figure("cycles", 12)
def cycles(run):
    """more scenes beside Cycles"""
    rows = []
    for name in ("veach", "glass", "daylight", "hall", "fog", "smoke", "cloud"):
        result = beside_cycles(run, name, "2,8,32,64", "1", 512).data["scenes"][0]
        check = next(each for each in result["checks"] if "ycles" in each["other"]["estimator"])
        bias = max(abs(value) for value in check["relative_bias"])
        rows.append([f"`{name}`"] + [number(to_peer(result, technique, 1)) for technique in ("path", "adaptive")]
                    + ["", f"{number(100 * bias)} %"])
    result = beside_cycles(run, "caustics", "1,4,16,64", "1", 512, "--reference-by", "vcm",
                           techniques="path,vcm").data["scenes"][0]
    rows.append(["`caustics`", number(to_peer(result, "path", 1)), "", number(to_peer(result, "vcm", 1)), ""])
    return table(["scene", "path", "adaptive", "vcm", "difference of the means"], rows)


@figure("embree", 4)
def embree(run):
    """rates of rays and builds beside Embree's best setting, and rays that are lost"""
    works = {"build": "build", "camera": "camera rays", "camera-bulk": "camera rays, many at a time",
             "bounce": "bounced rays", "shadow": "shadow rays"}
    rows, lost = [], []
    for mesh in ("meshes/test-ball.obj", "generated/octopus.obj"):
        data = run("compare", "kernels", f"models/{mesh}", "--scene", "room", "--repeats", 5, "--quiet").data
        best = {row["work"]: row for row in data["rows"] if row["best"] and row["threads"] == 1}
        triangles = f"{best['build']['triangles']:,}"
        for work, name in works.items():
            row = best[work]
            ours, peer = ((f"{number(1e3 * row[key])} ms" if work == "build" else f"{number(row[key])} M/s")
                          for key in ("ours", "peer"))
            rows.append([triangles, name, ours, f"{peer}, {row['peer_name'].removeprefix('embree 3.13.5 ')}",
                         number(row["ratio"]["median"])])
        for kernel in data["watertight"]:
            misses = 1e6 * (kernel["misses"] + kernel["edge_faults"]) / kernel["rays"]
            name = kernel["kernel"].replace("duet", "Duet").replace("embree 3.13.5", "Embree")
            lost.append([triangles, name, number(misses) if misses else "none"])
    return (table(["triangles", "work, one thread", "Duet", "Embree 3.13.5", "times as fast"], rows) + "\n\n" +
            table(["triangles", "kernel", "lost of a million rays that are aimed at edges and vertices"], lost))


@figure("integrators", 6)
def integrators(run):
    """relMSE of the integrators at equal time"""
    names = ("path", "bidirectional", "vcm", "photons", "metropolis")
    rows = []
    for name, size, judge in (("caustics", "160x120", "vcm"), ("cornell", "128x128", "path"),
                              ("glass", "128x128", "path"), ("spheres", "160x90", "path"),
                              ("door", "160x120", "bidirectional")):
        render = ("raytrace", scene(name), "--size", size, "--no-adaptive", "--quiet")
        reference = run(*render, "--integrator", judge, "--time", 40, "--seed", 1000, output=".exr")
        line = [f"`{name}`"]
        for integrator in names:
            image = run(*render, "--integrator", integrator, "--time", 5, output=".exr")
            metrics = run("compare", "images", image.output, reference.output, "--quiet").data
            line.append(number(metrics["relmse"]))
        rows.append(line)
    return table(["relMSE after 5 seconds"] + [f"`{name}`" for name in names], rows)


@figure("denoise", 6)
def denoise(run):
    """error and time with and without the denoiser, and its bias"""
    rows = []
    for name in ("cornell", "spheres", "glass", "demo", "hall"):
        data = run("compare", "bench", scene(name), "--techniques", "path,denoised", "--samplers", "sobol",
                   "--spp", "4,16,64,256", "--reference-spp", 4096, "--check-spp", 64, "--size", "160x90",
                   "--repeats", 4, "--quiet").data
        of = {(row["technique"], row["spp"]): row for row in data["scenes"][0]["rows"]}
        for spp in (4, 16, 64, 256):
            plain, denoised = of["path", spp], of["denoised", spp]
            rows.append([f"`{name}`", spp, number(plain["relmse"]["value"]), number(denoised["relmse"]["value"]),
                         number(denoised["bias_share"]), ms(plain["seconds"]["value"]),
                         ms(denoised["seconds"]["value"]), number(denoised["dominates"]["ratio"]["value"])])
    return table(["scene", "spp", "relMSE", "denoised", "bias / error", "ms", "denoised, ms", "dominates"], rows)


@figure("stop", 3)
def stop(run):
    """whether --error ends where it should, and what adaptive sampling gains"""
    rows = []
    for error, size, names in ((0.002, "64x48", ("cornell", "spheres", "amphora", "veach", "daylight")),
                               (0.005, "64x36", ("lanterns", "everything", "demo", "glass"))):
        data = run("compare", "stop", *map(scene, names), "--error", error, "--size", size).data
        for row in data["rows"]:
            gain = row["adaptive_to_even"]
            rows.append([f"`{stem(row['scene'])}`" + (", caustics" if row["caustics"] else ""), error,
                         number(row["median_relmse"] / row["asked_relmse"]), number(row["samples_per_pixel"]),
                         number(gain["relmse"]), number(gain["mse"])])
    return table(["scene", "`--error`", "achieved / requested, median", "samples per pixel", "adaptive / even: relMSE",
                  "MSE"], rows)


@figure("error-limit", 1)
def error_limit(run):
    """how long --error 0.001 takes"""
    rows = []
    for name, size in (("furnace", "160x120"), ("cornell-35", "128x128"), ("amphora", "100x120"), ("spheres", "160x90"),
                       ("veach", "160x120"), ("daylight", "160x120"), ("cornell", "128x128"), ("demo", "160x90"),
                       ("lanterns", "160x90"), ("everything", "160x120"), ("glass", "128x128")):
        data = run("raytrace", scene(name), "--error", 0.001, "--size", size, "--quiet", output=".png").data
        rows.append([f"`{name}`", size.replace("x", " × "), number(data["samples_per_pixel"]),
                     number(data["seconds"]["render"])])
    return table(["scene", "size", "samples per pixel", "seconds"], rows)
