"""The check of measured figures (compare/figures/blocks.py) accepts a page that was filled in, and finds each fault.

usage: blocks_test.py SOURCE_DIR
"""
import pathlib
import sys
import tempfile

sys.path.append(str(pathlib.Path(sys.argv[1]) / "compare" / "figures"))
import blocks  # noqa: E402
import catalog  # noqa: E402

EMPTY = "# Page\n\n<!-- figure: speed -->\n<!-- end of figure -->\n\nA limit of 10 seconds, with 2 threads.\n"
BODY = "| scene | ms |\n|---|---|\n| `a` | 12 |\n\n![A plot of two lines](gallery/speed.svg)"
LOOSE = {
    "a time in a table": "| what | value |\n|---|---|\n| load | 1.5 s |\n",
    "a rate in a table": "| what | value |\n|---|---|\n| rays | 30 Mrays/s |\n",
    "a ratio in a table": "| what | value |\n|---|---|\n| tiles | 1.3 times as fast |\n",
    "a number in a measured column": "| scene | relMSE |\n|---|---|\n| a | 0.0017 |\n",
    "two numbers in one": "| scene | ms, relMSE |\n|---|---|\n| a | 8.4, 0.0031 |\n",
    "a number in a measured row": "| what | a | b |\n|---|---|---|\n| seconds | 3 | 4 |\n",
    "a time in prose": "This stage takes 40 ms.\n",
    "a ratio in prose": "It is 1.55 times as fast.\n",
    "an error in prose": "There its relMSE is 0.03.\n",
}
NO_FIGURES = ("| option | meaning |\n|---|---|\n| `--time 5 s` | 16 samples in 3 passes |\n", "```\n40 ms\n```\n",
              "| threads | cores |\n|---|---|\n| 1 | 2 |\n", "The worker has 60 seconds.\n")


def expect(condition, what):
    if not condition:
        raise SystemExit(f"failed: {what}")


def found(source, text, known=("speed",), page="raster/README.md"):
    return blocks.faults({source / page: text}, known, source)


def main():
    for value, digits, words in ((0, 2, "0"), (1234.5, 2, "1,234"), (0.0123, 2, "0.012"), (6.54e-5, 2, "6.5e-5"),
                                 (9.99, 2, "10"), (float("nan"), 2, "–"), (None, 2, "–")):
        expect(catalog.number(value, digits) == words, f"{value} is '{catalog.number(value, digits)}', not '{words}'")
    with tempfile.TemporaryDirectory() as name:
        source = pathlib.Path(name)
        for folder in ("raster", "gallery"):
            (source / folder).mkdir()
        plot, page = source / "gallery" / "speed.svg", source / "raster" / "README.md"
        plot.write_text("<svg>1</svg>", encoding="utf-8")
        good = blocks.fill(page, EMPTY, "speed", BODY, source)
        expect("](../gallery/speed.svg)" in good and "| `a` | 12 |" in good, "fill writes the table and a path")
        expect(blocks.fill(page, good, "speed", BODY, source) == good, "fill replaces what it wrote")
        expect(not found(source, good), f"a filled page is good: {found(source, good)}")
        for kind, text in LOOSE.items():
            expect(found(source, good + "\n" + text), f"{kind} is found")
        for text in NO_FIGURES:
            expect(not found(source, good + "\n" + text), f"nothing is found in {text!r}")
        plain = "\n| a | b |\n|---|---|\n| c | 7 |\n"
        expect(found(source, good + plain, page="raster/measurements.md"), "any number on a page of measurements")
        expect(found(source, EMPTY), "an empty block")
        expect(found(source, good.replace("12", "11")), "a number changed by hand")
        expect(found(source, good, known=("other", "speed")), "a figure that no page shows")
        expect(found(source, good, known=()), "a figure that no function makes")
        expect(found(source, good.replace("<!-- end of figure -->", "")), "a block without an end")
        plot.write_text("<svg>2</svg>", encoding="utf-8")
        expect(found(source, good), "a plot changed by hand")
        plot.write_text("<svg>1</svg>", encoding="utf-8")
        (source / "gallery" / "other.svg").write_text("<svg/>", encoding="utf-8")
        expect(found(source, good), "a plot that no figure shows")


if __name__ == "__main__":
    main()
