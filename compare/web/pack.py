#!/usr/bin/env python3
"""Puts the web page together: index.html and lessons.html with the workers' code in them, and a script for each file of
the scenes and for each lesson's program.

A page that is opened as a file may load scripts, but neither other files nor workers. So the workers' code is text
inside of the page, and files of scenes and WebAssembly are scripts that hold them in base64.

usage: pack.py BUILD MODELS FOLDER        (BUILD: the folder in which Emscripten has built compare/web)
"""
import base64
import json
import pathlib
import re
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'lessons'))
import course  # noqa: E402

PAGE = pathlib.Path(__file__).parent / 'page'
FIRST = ['cornell', 'spheres', 'demo', 'veach', 'glass', 'everything']  # first scenes in the menu


def strings(value):
    """Yields all strings of a JSON value."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, (list, dict)):
        for part in value.values() if isinstance(value, dict) else value:
            yield from strings(part)


def named_files(path, root):
    """Yields the file and those that it names, relative to root: meshes and images of scenes, materials of meshes."""
    yield path
    if path.suffix == '.json':
        names = strings(json.loads((root / path).read_text()))
    elif path.suffix in ('.obj', '.mtl'):
        lines = (root / path).read_text().splitlines()
        names = [line.split()[-1] for line in lines if re.match(r'mtllib|map_|bump|norm', line.strip())]
    else:
        names = []
    for name in dict.fromkeys(names):
        if re.fullmatch(r'[\w./-]+', name) and (root / path.parent / name).is_file():
            yield from named_files(path.parent / name, root)


def file_script(path, models):
    """Returns a script that hands a file to the page."""
    return f'addFile({json.dumps(path)}, "{base64.b64encode((models / path).read_bytes()).decode()}");\n'


def models_of(program, models):
    """Returns the files of models/ that a lesson's program reads: it has their paths, or names of meshes that it makes
    paths of."""
    def is_named(path):
        name = path.relative_to(models).as_posix()
        is_completed = name.startswith('meshes/') and 'meshes/" + ' in program and f'"{path.stem}"' in program
        return name in program or is_completed

    files = [path for path in sorted(models.glob('*/*')) if path.suffix in ('.obj', '.png') and is_named(path)]
    if 'DUET_MODELS' in program and not files:
        sys.exit('pack: a lesson reads files of models/, but none of those there is named in its program')
    return [path.relative_to(models).as_posix() for path in files]


def headers_of(path, found):
    """Adds the headers of lessons that a file includes, directly or not, to found: {path: text}."""
    for name in re.findall(r'#include "(\w+/lessons/[^"]+)"', path.read_text()):
        if name not in found:
            found[name] = (course.SOURCE / name).read_text()
            headers_of(course.SOURCE / name, found)
    return found


def lesson_script(lesson, build):
    """Returns a script that hands a lesson's program to the page, with the sources that the program reads itself."""
    program = lesson.folder / 'lesson.cpp'
    module = {'code': (build / f'lesson_{lesson.id}.js').read_text(),
              'wasm': base64.b64encode((build / f'lesson_{lesson.id}.wasm').read_bytes()).decode(),
              'texts': headers_of(program, {}) if 'DUET_MODELS "../"' in program.read_text() else {}}
    return f'addLesson({json.dumps(lesson.id)}, {json.dumps(module)});\n'


def write_lessons(build, models, folder):
    """Writes the lessons' programs, and course.js: what the menu shows, and which files of models/ they read."""
    (folder / 'lessons').mkdir()
    entries = []
    for lesson in course.lessons():
        (folder / 'lessons' / f'{lesson.id}.js').write_text(lesson_script(lesson, build))
        captions = re.findall(r'!\[([^\]]*)\]\(figures/([\w.-]+)\)', lesson.page.read_text())
        entries.append({'id': lesson.id, 'room': course.ROOMS[lesson.room], 'title': lesson.title(),
                        'page': lesson.page.relative_to(course.SOURCE).as_posix(),
                        'files': models_of((lesson.folder / 'lesson.cpp').read_text(), models),
                        'captions': {name: text for text, name in captions}})
    (folder / 'course.js').write_text(f"'use strict';\nconst course = {json.dumps(entries)};\n")
    return {name for entry in entries for name in entry['files']}


def write_page(folder, name, marker, worker):
    """Writes a page with its worker's code."""
    if '</script' in worker.lower():
        sys.exit(f'pack: the code of the workers of {name} contains "</script"')
    (folder / name).write_text((PAGE / name).read_text().replace(marker, worker))


def main(build, models, folder):
    if folder.exists() and not (folder / 'scenes.js').exists() and any(folder.iterdir()):
        sys.exit(f'pack: {folder} is not empty, and no page that could be replaced')
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    write_page(folder, 'index.html', '<!-- worker -->',
               (build / 'duet.js').read_text() + (PAGE / 'worker.js').read_text())
    write_page(folder, 'lessons.html', '<!-- lesson worker -->', (PAGE / 'lesson_worker.js').read_text())
    for part in PAGE.iterdir():
        if part.suffix != '.html' and not part.name.endswith('worker.js'):
            shutil.copyfile(part, folder / part.name)
    names = sorted(path.stem for path in models.glob('*.json') if path.stem != 'scene.schema')
    names.sort(key=lambda scene: FIRST.index(scene) if scene in FIRST else len(FIRST))
    scenes = {name: [path.as_posix() for path in dict.fromkeys(named_files(pathlib.Path(name + '.json'), models))]
              for name in names}
    for path in {path for paths in scenes.values() for path in paths} | write_lessons(build, models, folder):
        script = folder / 'files' / (path + '.js')
        script.parent.mkdir(parents=True, exist_ok=True)
        script.write_text(file_script(path, models))
    (folder / 'scenes.js').write_text(f"'use strict';\nconst scenes = {json.dumps(scenes)};\n")


if __name__ == '__main__':
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*map(pathlib.Path, sys.argv[1:]))
