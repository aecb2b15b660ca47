"""Drives `compare view` in a window on a virtual screen with random input: clicks, drags, the wheel, keys, files that
other programs write. Fails if the program ends, or if a scene that it saved cannot be loaded.

usage: python3 tests/fuzz/window.py BIN_FOLDER [SECONDS [SEED]]        (default: 60 s, seed 1)
With the programs of the preset `asan` it also finds faults of memory.
"""
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SIZE = (1180, 800)
KEYS = ["1", "2", "3", "4", "5", "space", "f", "Escape", "r", "question", "ctrl+z", "ctrl+y", "ctrl+z", "ctrl+d",
        "Delete", "ctrl+s", "w", "a", "s", "d", "q", "e", "Tab", "Return", "7", "minus", "period", "BackSpace"]
BROKEN = ["", "{", "[]", '{"camera": 3}', "\0\0"]


class Screen:
    """A virtual screen."""

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x800x24", "-nolisten",
                                        "tcp"], pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            os.environ["DISPLAY"] = ":" + pipe.readline().strip()
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


def xdotool(*words):
    subprocess.run(["xdotool", *map(str, words)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def drag(draw):
    xdotool("mousemove", draw.randrange(SIZE[0]), draw.randrange(SIZE[1]))
    modifier = draw.choice([None, None, "ctrl", "shift"])
    if modifier:
        xdotool("keydown", modifier)
    button = draw.choice([1, 1, 1, 2])
    xdotool("mousedown", button)
    for _ in range(draw.randrange(6)):
        xdotool("mousemove_relative", "--", draw.randint(-60, 60), draw.randint(-60, 60))
        time.sleep(0.02)
    xdotool("mouseup", button)
    if modifier:
        xdotool("keyup", modifier)


def act(draw, scene, original):
    """One random action."""
    kind = draw.random()
    if kind < 0.5:
        drag(draw)
    elif kind < 0.6:
        xdotool("click", draw.choice([4, 5]))
    elif kind < 0.62:
        scene.write_text(draw.choice(BROKEN))
    elif kind < 0.64:
        scene.write_text(original)
    else:
        xdotool("key", draw.choice(KEYS))


def loads(folder, scene):
    run = subprocess.run([folder / "raytrace", scene, "-o", scene.with_suffix(".exr"), "--size", "8x8", "--spp", "1",
                          "--quiet"], capture_output=True, text=True, check=False)
    return run.returncode == 0 or print(f"a saved scene cannot be loaded: {run.stderr}")


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    seconds, seed = float(sys.argv[2]) if len(sys.argv) > 2 else 60, int(sys.argv[3]) if len(sys.argv) > 3 else 1
    draw, actions, saved = random.Random(seed), 0, None
    with tempfile.TemporaryDirectory() as scratch, Screen():
        models = pathlib.Path(scratch) / "models"
        (models / "meshes").mkdir(parents=True)
        for mesh in (SOURCE / "models" / "meshes").glob("cornell-*.obj"):
            shutil.copy(mesh, models / "meshes")
        scene, original = models / "scene.json", (SOURCE / "models" / "cornell.json").read_text()
        scene.write_text(original)
        window = subprocess.Popen([folder / "compare", "view", scene, "--window", f"{SIZE[0]}x{SIZE[1]}", "--size",
                                   "96x96", "--spp", "16", "-o", scratch])
        xdotool("search", "--sync", "--onlyvisible", "--name", "Duet", "windowmove", 0, 0, "windowfocus")
        end = time.time() + seconds
        while time.time() < end and window.poll() is None:
            act(draw, scene, original)
            actions += 1
            text = scene.read_text(errors="replace")
            if text not in (saved, original, *BROKEN):
                saved = text
                if not loads(folder, scene):
                    window.kill()
        failed = window.poll() is not None
        window.terminate()
        window.wait()
    print(f"seed {seed}: {actions} actions in {seconds:.0f} s, {'FAILED' if failed else 'no fault'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
