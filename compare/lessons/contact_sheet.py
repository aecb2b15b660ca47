"""Writes index.html beside the pictures of all lessons.

usage: contact_sheet.py SOURCE_DIR LESSONS_OUT
"""
import pathlib
import sys

pathlib.Path(sys.argv[2], "index.html").write_text("<!doctype html><title>Lessons</title>\n")
