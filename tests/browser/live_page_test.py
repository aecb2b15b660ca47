"""The web page of both pipelines, opened as a file in a real browser: open, look, orbit, pick, move, undo, edit, add,
compare, save. `sh compare/web/build.sh` builds it first; it takes long, so that without a page this test is skipped."""

import gzip
import json
import os
import pathlib
import sys

import checks
import support

FOLDER = pathlib.Path(os.environ.get("DUET_WEB", "build/web")).absolute()
SHOWN = (".every(p => p.frame && !p.frame.preview && p.frame.width === imageSize.width"
         " && (p !== tracer || p.frame.samples >= %d))")


class LivePage(support.PageTest):
    def start(self, scene="cornell"):
        page = self.browser.open((FOLDER / "index.html").as_uri(), width=1000, height=560, hash_state=scene)
        self.addCleanup(page.close)
        self.addCleanup(lambda: self.assertEqual(page.faults, []))
        self.shown(page)
        return page

    def shown(self, page, samples=4):
        """Waits until both images are there in full size, and nothing is being done."""
        page.wait("imageSize.width > 1 && raster.waiting.size + tracer.waiting.size === 0", timeout=60)
        page.wait("pipelines" + SHOWN % samples, timeout=120)

    def center(self, page, selector="#frame", at=(0.5, 0.5)):
        left, top, width, height = page.box(selector)
        return left + at[0] * width, top + at[1] * height

    def mean(self, page, canvas):
        """The mean of the sRGB bytes of a canvas."""
        return page.js(f"""(c => {{ const p = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
            let sum = 0; for (let i = 0; i < p.length; ++i) sum += i % 4 === 3 ? 0 : p[i];
            return sum / (p.length * 3 / 4); }})(document.querySelector("{canvas}"))""")

    def saved(self, page):
        return json.loads(page.js("save()"))

    def test_images(self):
        page = self.start()
        raster, traced = self.mean(page, "#raster"), self.mean(page, "#traced")
        self.assertGreater(raster, 20)
        self.assertLess(abs(raster - traced), 0.1 * raster)
        folder = FOLDER.as_uri()
        self.assertEqual([r for r in page.requests if not r.startswith((folder, "blob:", "data:"))], [])
        page.screenshot(self.scratch / "start.png")
        page.js("addHelper(); openScene('cornell')")  # a path tracer with another seed
        page.wait("tracer.frame && tracer.frame.samples > tracer.frame.own && tracer.frame.own > 0", timeout=120)
        self.shown(page)
        self.assertLess(abs(self.mean(page, "#traced") - traced), 0.1 * traced)
        size = len(gzip.compress((FOLDER / "index.html").read_bytes()))
        self.assertLess(size, 8e6)  # bytes, without the scenes
        self.assertEqual(checks.names(page), [])
        self.assertEqual(checks.sideways(page), [])
        self.assertEqual(checks.contrast(page), [])

    def test_edits(self):
        page = self.start()
        before = self.saved(page)
        x, y = self.center(page, at=(0.25, 0.5))  # beside the line between the images
        page.drag((x, y), (x + 60, y - 20))       # orbit
        self.shown(page)
        page.click_at(*self.center(page, at=(0.62, 0.8)))  # the short block
        page.wait("selected >= 0", timeout=30)
        name = page.js("state.scene.objects[selected].file || state.scene.objects[selected].type")
        self.assertIn("short", name)
        page.wait("document.querySelector('#path').textContent.length > 100", timeout=30)
        selected = page.js("selected")
        page.js(f"send({{do: 'move', path: objectPath(), by: [0.1, 0, 0]}})")
        self.shown(page)
        after = self.saved(page)
        self.assertNotEqual(after["camera"]["eye"], before["camera"]["eye"])
        self.assertNotEqual(after["objects"][selected], before["objects"][selected])
        page.screenshot(self.scratch / "edited.png")

        page.js("document.activeElement.blur()")
        page.key("z", modifiers=2)
        page.key("z", modifiers=2)
        self.shown(page)
        self.assertEqual(self.saved(page), before)

        page.js("$('add').value = 'sphere'; $('add').onchange()")
        page.wait(f"state.scene.objects.length === {len(before['objects']) + 1}", timeout=30)
        self.shown(page)
        self.assertEqual(self.saved(page)["objects"][-1]["type"], "sphere")
        self.assertFalse(page.js("Boolean($('message').textContent)"))

    def test_comparison_and_dropped_files(self):
        page = self.start("spheres")
        page.js("document.activeElement.blur()")
        page.key("5")
        page.wait("$('left-tag').textContent.startsWith('FLIP, mean')", timeout=60)
        page.wait("Number($('left-tag').textContent.split(' ').pop()) < 0.3", timeout=60)
        page.screenshot(self.scratch / "flip.png")
        page.key("1")
        tetrahedron = "v 0 0 0\\nv 1 0 0\\nv 0 1 0\\nv 0 0 1\\nf 1 3 2\\nf 1 2 4\\nf 2 3 4\\nf 1 4 3\\n"
        page.js(f"openFilesOf([new File(['{tetrahedron}'], 'four.obj')], true)")
        page.wait("state.scene.objects.at(-1).file === 'four.obj'", timeout=30)
        page.js(f"openFilesOf([new File(['{tetrahedron}'], 'four.obj')], false)")
        page.wait("state.file === 'four.obj'", timeout=30)
        self.shown(page)
        self.assertGreater(self.mean(page, "#raster"), 20)
        page.js("openFilesOf([new File(['{\"objects\": 1}'], 'broken.json')], false)")
        page.wait("$('message').textContent.includes('broken.json')", timeout=30)
        self.assertEqual(page.js("state.file"), "four.obj")


if __name__ == "__main__":
    if not (FOLDER / "index.html").exists():
        print(f"SKIPPED: no page in {FOLDER}. Build it: sh compare/web/build.sh")
        sys.exit(77)
    support.main()
