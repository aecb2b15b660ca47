#!/usr/bin/env python3
"""Puts the web page together: index.html with the workers' code in it, and a script for each file of the scenes.

A page that is opened as a file may load scripts, but neither other files nor workers. So the workers' code is text
inside of the page, and files of scenes are scripts that hold them in base64.

usage: pack.py DUET_JS MODELS FOLDER
"""
import base64
import json
import pathlib
import re
import shutil
import sys

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


def main(duet_js, models, folder):
    if folder.exists() and not (folder / 'scenes.js').exists() and any(folder.iterdir()):
        sys.exit(f'pack: {folder} is not empty, and no page that could be replaced')
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    worker = duet_js.read_text() + (PAGE / 'worker.js').read_text()
    if '</script' in worker.lower():
        sys.exit('pack: the code of the workers contains "</script"')
    page = (PAGE / 'index.html').read_text().replace('<!-- worker -->', worker)
    (folder / 'index.html').write_text(page)
    for part in PAGE.iterdir():
        if part.name not in ('index.html', 'worker.js'):
            shutil.copyfile(part, folder / part.name)
    names = sorted(path.stem for path in models.glob('*.json') if path.stem != 'scene.schema')
    names.sort(key=lambda scene: FIRST.index(scene) if scene in FIRST else len(FIRST))
    scenes = {name: [path.as_posix() for path in dict.fromkeys(named_files(pathlib.Path(name + '.json'), models))]
              for name in names}
    for path in {path for paths in scenes.values() for path in paths}:
        script = folder / 'files' / (path + '.js')
        script.parent.mkdir(parents=True, exist_ok=True)
        script.write_text(file_script(path, models))
    (folder / 'scenes.js').write_text(f"'use strict';\nconst scenes = {json.dumps(scenes)};\n")


if __name__ == '__main__':
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*map(pathlib.Path, sys.argv[1:]))
