"""Defines the figures of compare/README.md and of the first page."""
from catalog import FIGURES, figure, number, scene, stem, table
from raster_figures import equal_error, llvmpipe, phong_frames, raster_bench
from raytrace_figures import BOOK_SECONDS, cornell, cornell_bench, cover_seconds, to_peer


@figure("ladder", 1)
def ladder(run):
    """the rungs of the demo scene: error, time of both pipelines, share of the difference"""
    data = run("compare", "ladder", scene("demo"), "--size", "320x180", "--spp", 64, output="").data
    shares = {share["cause"]: share["share"] for share in data["shares"]}
    rows = []
    for rung in data["rungs"]:
        for quantity in rung["quantities"]:
            seconds = quantity["seconds"]
            share = f"{100 * shares[rung['id']]:.1f} %" if rung["id"] in shares else ""
            rows.append([rung["rung"], quantity["name"], number(quantity.get("metrics", {}).get("rmse")),
                         number(1000 * seconds["raster"]), number(1000 * seconds["raytrace"]), share])
    return table(["rung", "quantity", "RMSE", "rasterizer, ms", "path tracer, ms", "share of the difference"], rows)


def span(values):
    return f"{number(min(values))} to {number(max(values))}"


@figure("headline", 15)
def headline(run):
    """the table and the three plots of the first page (measurements of other figures)"""
    frames = [row["ratio"]["median"] for row in phong_frames(run)]
    cover, _ = cover_seconds(run, 2)
    box = cornell_bench(run).data["scenes"][0]
    equal = {stem(result["scene"]): row["dominates"]["ratio"]["value"] for result in raster_bench(run).data["scenes"]
             for row in result["rows"] if row["technique"] == "raster" and row["spp"] == 1 and row["dominates"]}
    coverage = run("compare", "stress", "--only", "coverage/exact-integers").data["tests"][0]
    path = "raytrace/measurements.md"
    plots = " | ".join(plot(run)[0].split("\n")[-1] if plot is not cornell else
                       next(line for line in plot(run)[0].split("\n") if line.startswith("![")) for plot in
                       (llvmpipe, cornell, equal_error))
    return table(["what", "figure", "page"], [
        ["a frame of a mesh: llvmpipe's time divided by the rasterizer's; above 1 ours is faster", span(frames),
         "[raster](raster/measurements.md#frames-beside-llvmpipe)"],
        ["Cornell box after 1 s and 4 s: the path tracer's squared error divided by Cycles'; lower is better",
         ", ".join(number(to_peer(box, "path", at)) for at in (1, 4)), f"[raytrace]({path}#the-cornell-box)"],
        ["cover of *Ray Tracing in One Weekend*: seconds on two threads; the book's program on one, quoted",
         f"{number(cover, 3)}; {BOOK_SECONDS}", f"[raytrace]({path}#the-cover-scene)"],
        ["how many times as long the path tracer takes to have as small an error as the rasterizer at one sample per "
         "pixel", span(equal.values()), "[raster](raster/measurements.md#error-against-time)"],
        [f"{coverage['trials']:,} random triangles: samples covered wrongly, by exact 128-bit arithmetic",
         coverage["failures"], "[tests](tests/README.md#what-the-tests-show)"],
    ]) + f"\n\n| the rasterizer | the path tracer | both |\n|---|---|---|\n| {plots} |"
