"""Runs the program of one lesson in a folder of its own, and notes its time and its length in lesson.json.

usage: run_lesson.py ID LESSON_FOLDER PROGRAM OUT_FOLDER
"""
import json
import pathlib
import subprocess
import sys
import time

import course


def main():
    lesson_id, folder, program, out = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3], pathlib.Path(sys.argv[4])
    out.mkdir(parents=True, exist_ok=True)
    for old in out.iterdir():
        old.unlink()
    start = time.monotonic()
    status = subprocess.run([program], cwd=out, check=False).returncode
    seconds = time.monotonic() - start
    if status != 0:
        sys.exit(f"lesson {lesson_id}: its program {program} ended with exit code {status}; expected 0")
    if not any((out / f"evidence{ending}").exists() for ending in (".png", ".svg")):
        sys.exit(f"lesson {lesson_id}: its program wrote no evidence.png (or .svg) into {out}")
    lines = course.Lesson(folder).program_lines()
    (out / "lesson.json").write_text(json.dumps({"id": lesson_id, "folder": str(folder), "seconds": round(seconds, 2),
                                                 "lines": lines}))


if __name__ == "__main__":
    main()
