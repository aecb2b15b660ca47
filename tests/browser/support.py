"""The frame of the browser tests: one browser a file, pages made by the program `compare`.

usage: python3 FILE_test.py BIN SCRATCH        (tests/browser/run.sh)
Exit code 77: no browser here, and nothing was tested; where the variable CI is set that is a failure."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import checks
import chromium


class PageTest(unittest.TestCase):
    """A test with a browser (self.browser) and a scratch folder; what it opens is closed after it."""

    browser = bin = scratch = None

    @classmethod
    def make(cls, name, *arguments, before=None):
        """The address of the page that `compare ARGUMENTS… -o FOLDER` writes, made once."""
        folder = cls.scratch / name
        if not (folder / "index.html").exists():
            folder.mkdir(parents=True, exist_ok=True)
            if before:
                before(folder)
            texts = [str(folder / a[1:]) if a.startswith("@") else a for a in arguments] # @FILE: in that folder
            done = subprocess.run([cls.bin / "compare", *texts, "-o", folder, "--quiet"], capture_output=True,
                                  text=True)
            if done.returncode:
                raise RuntimeError(f"compare {' '.join(texts)}: {done.stderr}")
        return (folder / "index.html").as_uri()

    @classmethod
    def figures(cls, name):
        return json.loads((cls.scratch / name / "report.json").read_text())

    def open(self, url, **how):
        """A page; at the test's end it must have been free of errors and must have asked the network for nothing."""
        page = self.browser.open(url, **how)
        self.addCleanup(page.close)
        self.addCleanup(lambda: self.assertEqual(checks.quiet(page, url), []))
        return page


def main():
    PageTest.bin, PageTest.scratch = (pathlib.Path(p).absolute() for p in sys.argv[1:3])
    path = chromium.find()
    if not path:
        print(f"SKIPPED: no Chromium found ({', '.join(chromium.NAMES)})")
        sys.exit(1 if os.environ.get("CI") else 77)
    shutil.rmtree(PageTest.scratch, ignore_errors=True)
    PageTest.scratch.mkdir(parents=True)
    PageTest.browser = chromium.Browser(path)
    try:
        result = unittest.main(module="__main__", argv=sys.argv[:1] + sys.argv[3:], exit=False, verbosity=2).result
    finally:
        PageTest.browser.close()
    sys.exit(0 if result.wasSuccessful() and result.testsRun else 1)
