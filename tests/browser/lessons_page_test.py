"""The page of lessons, opened as a file in a real browser: choose a lesson, see its images, move a slider, reset. The
images are those of the native programs. `sh compare/web/build.sh` builds the page first; it takes long, so that without
a page this test is skipped."""

import base64
import gzip
import json
import os
import pathlib
import sys

import checks
import support

FOLDER = pathlib.Path(os.environ.get("DUET_WEB", "build/web")).absolute()
SOURCE = pathlib.Path(__file__).resolve().parents[2]
# Counts the bytes of two images, given as URLs, that differ by more than 1. The images have no alpha.
DIFFERENCE = """(async (a, b) => {
    const pixels = async url => {
        const image = new Image();
        image.src = url;
        await image.decode();
        const canvas = new OffscreenCanvas(image.naturalWidth, image.naturalHeight);
        const context = canvas.getContext("2d");
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, canvas.width, canvas.height);
    };
    const [p, q] = [await pixels(a), await pixels(b)];
    if (p.width !== q.width || p.height !== q.height) return `${p.width} × ${p.height}, ${q.width} × ${q.height}`;
    return p.data.reduce((count, byte, i) => count + (Math.abs(byte - q.data[i]) > 1), 0) / p.data.length;
})"""


class LessonsPage(support.PageTest):
    def open_lesson(self, lesson):
        page = self.browser.open((FOLDER / "lessons.html").as_uri(), width=1280, height=720, hash_state=lesson)
        self.addCleanup(page.close)
        self.addCleanup(lambda: self.assertEqual(page.faults, []))
        self.finished(page)
        return page

    def finished(self, page):
        """Waits until the program has ended and no other run is to begin."""
        page.wait("parameters.length > 0 && !running && !isWaiting", timeout=180)
        self.assertRegex(page.text("#message"), r"^[\d.]+ seconds$")

    def image(self, page, name):
        """Returns an image file that the page shows, as a data URL."""
        return page.js(f"""fetch(document.getElementById("image-{name}").querySelector("img").src)
            .then(reply => reply.blob()).then(blob => new Promise(done => {{
                const reader = new FileReader();
                reader.onload = () => done(reader.result);
                reader.readAsDataURL(blob);
            }}))""")

    def difference(self, page, lesson_folder, name):
        """Returns the fraction of bytes that differ by more than 1 from the figure of the lesson's page."""
        figure = base64.b64encode((SOURCE / lesson_folder / "figures" / name).read_bytes()).decode()
        return page.js(f"{DIFFERENCE}({json.dumps(self.image(page, name))}, 'data:image/png;base64,{figure}')")

    def test_menu_slider_and_reset(self):
        page = self.open_lesson("raytrace-02")
        page.js("$('lesson').value = 'raster-04'; $('lesson').onchange()")
        page.wait("lesson.id === 'raster-04' && parameters.length === 3", timeout=60)
        self.finished(page)
        self.assertEqual(page.text("#title"), "raster-04 · Camera, perspective, matrices")
        self.assertEqual(page.js("document.querySelectorAll('figure img').length"), 8)
        self.assertTrue(page.js("[...document.querySelectorAll('figure img')].every(i => i.naturalWidth > 100)"))
        self.assertEqual(page.js("document.querySelector('figure').id"), "image-evidence.png")
        first = self.image(page, "evidence.png")
        page.screenshot(self.scratch / "lesson.png")

        page.js("document.getElementById('field-of-view').focus()")
        for _ in range(5):
            page.key("ArrowRight")
        self.finished(page)
        self.assertNotEqual(self.image(page, "evidence.png"), first)
        self.assertIn("lesson_raster-04_program --field-of-view 0.65", page.text("#command"))
        page.screenshot(self.scratch / "moved.png")

        page.click("#reset")
        self.finished(page)
        self.assertEqual(self.image(page, "evidence.png"), first)
        self.assertNotIn("--", page.text("#command"))

    def test_drag_stays_responsive(self):
        page = self.open_lesson("raster-04")
        left, top, width, height = page.box("#eye-height")
        page.drag((left + 0.2 * width, top + height / 2), (left + 0.9 * width, top + height / 2))
        self.assertTrue(page.js("running !== null"))
        value = page.js("optionsOf().join(' ')")
        self.finished(page)
        self.assertRegex(value, r"--eye-height [67]\.\d+")
        self.assertIn(value, page.text("#command"))
        page.js("open('raytrace-10')") # a long run is stopped, and another lesson opens at once
        page.wait("running", timeout=60)
        page.js("open('raster-02')")
        page.wait("lesson.id === 'raster-02' && parameters.length === 2", timeout=20)
        self.finished(page)

    def test_images_are_those_of_the_programs(self):
        page = self.open_lesson("raytrace-02")
        for lesson, folder, name in (("raytrace-02", "raytrace/lessons/02-sphere", "evidence.png"),
                                     ("raster-04", "raster/lessons/04-camera", "evidence.png"),
                                     ("raster-10", "raster/lessons/10-ambient-occlusion", "evidence.png")):
            page.js(f"open('{lesson}')")
            page.wait(f"lesson.id === '{lesson}' && document.getElementById('image-{name}')", timeout=120)
            self.finished(page)
            self.assertLess(self.difference(page, folder, name), 1e-4, lesson)

    def test_failure_and_page(self):
        page = self.open_lesson("raytrace-01")
        self.assertIn("a·b = 12", page.text("#output"))
        page.js("parameters[0].option = '--none'; parameters[0].slider.value = 1; change()")
        page.wait("!running && $('message').textContent.startsWith('The program failed')", timeout=30)
        self.assertIn('unknown option: found "--none"', page.text("#message"))
        self.assertEqual([r for r in page.requests if not r.startswith((FOLDER.as_uri(), "blob:", "data:"))], [])
        for check in (checks.names, checks.sideways, checks.contrast, checks.keyboard):
            self.assertEqual(check(page), [])
        size = sum(len(gzip.compress(path.read_bytes())) for path in FOLDER.rglob("*")
                   if path.is_file() and "files" not in path.relative_to(FOLDER).parts)
        self.assertLess(size, 8e6)  # bytes, without the scenes

    def test_menu_of_the_first_page(self):
        page = self.browser.open((FOLDER / "index.html").as_uri(), width=1280, height=720)
        self.addCleanup(page.close)
        page.js("$('lesson').value = 'raster-02'; $('lesson').onchange()")
        page.wait("document.title.endsWith('Duet') && typeof course !== 'undefined' && typeof lesson === 'object' "
                  "&& lesson && lesson.id === 'raster-02' && parameters.length", timeout=60)
        self.finished(page)


if __name__ == "__main__":
    if not (FOLDER / "lessons.html").exists():
        print(f"SKIPPED: no page in {FOLDER}. Build it: sh compare/web/build.sh")
        sys.exit(77)
    support.main()
