#!/bin/sh
# Checks the vocabulary and the form of the source files: words that the field of rendering has better words for, lines
# over 120 columns, comments that begin as fragments, and British spellings. Quoted titles keep their words.
# usage: words.sh SOURCE_DIR
set -eu
cd "$1"
exec python3 -B - <<'END'
import re
import subprocess
import sys

COLUMNS = 120
# Words in identifiers, and what to call the thing. They are compared with the parts of a name, divided at _ and
# capitals.
IDENTIFIERS = {
    'nearness': 'reversed depth', 'looker': 'G-buffer pass', 'surroundings': 'screen-space tracer',
    'scenery': 'reflection source',
    'arrival': 'light sample', 'insides': 'medium stack', 'told': 'log, messages',
    'gatherer': 'BVH input', 'twin': 'duplicate', 'sabotage': 'mutation', 'sabotaged': 'mutation', 'picture': 'image',
    'lamp': 'light, area light, emitter', 'sixteen': 'packet, lanes', 'veil': 'alpha blend',
}
# Phrases in comments, messages and titles.
PHRASES = {
    r'nearness': 'reversed depth', r'set-ups?\b': 'setup', r'left on the way': 'transmittance',
    r'worked out': 'computed',
    r'looked up in\b': 'sampled', r'asked (for|of)\b': 'requested, queried', r'side by side in lanes': 'SIMD',
    r'insides\b': 'medium stack', r'\btwins?\b': 'duplicates', r'sabotag': 'mutation', r'\blamps?\b': 'light, emitter',
    r'\barrivals?\b': 'light sample', r'\bveils?\b': 'alpha blend',
}
BRITISH = {
    'colour': 'color', 'centre': 'center', 'normalis': 'normaliz', 'neighbour': 'neighbor', 'behaviour': 'behavior',
    'metre': 'meter',
    'grey': 'gray', 'optimis': 'optimiz', 'initialis': 'initializ', 'rasteris': 'rasteriz', 'modelled': 'modeled',
    'labelled': 'labeled',
}
SOURCES = ('.h', '.cpp', '.py', '.sh', '.js', '.css', '.cmake', 'CMakeLists.txt')
faults = 0


def fault(path, line, what):
    global faults
    faults += 1
    print(f'{path}:{line}: {what}')


def parts(name):
    return re.sub(r'([a-z0-9])([A-Z])', r'\1_\2', name).lower().split('_')


def check_line(path, number, line):
    """Checks one line of C++: its code without strings, its comment, and its strings."""
    code, comment = re.fullmatch(r'((?:[^"/]|"(?:[^"\\]|\\.)*"|/(?!/))*)(//.*)?.*', line).groups()
    strings = [s for s in re.findall(r'"((?:[^"\\]|\\.)*)"', code) if ' ' in s]  # not names
    if not line.startswith('#include'):
        for name in re.findall(r'[A-Za-z_]\w*', re.sub(r'"(?:[^"\\]|\\.)*"', '', code)):
            for part in parts(name):
                for form in {part, part.removesuffix('s')} & IDENTIFIERS.keys():
                    fault(path, number, f"'{name}': say {IDENTIFIERS[form]}")
    for text in [comment or ''] + strings:
        text = re.sub(r'"[^"]*"|`[^`]*`', '', text)
        for phrase, instead in PHRASES.items():
            if re.search(phrase, text):
                fault(path, number, f"'{re.search(phrase, text)[0]}': say {instead}")
        for british, american in BRITISH.items():
            if re.search(r'\b' + british, text, re.I):
                fault(path, number, f"'{british}': write {american}")


def check_comment(path, number, line, before):
    """A block of comments begins with a capital letter, a number or a name of the code."""
    found = re.match(r'\s*///?\s+([a-z]+)\b(?![(_.])', line)
    if not found or before.lstrip().startswith('//'):
        return
    rest = open(path, encoding='utf-8').read()
    code = re.sub(r'//.*', '', rest)
    if (not re.search(r'\b' + found[1] + r'\b', code)
                and found[1] not in ('stb', 'sin', 'cos', 'tan', 'asin', 'c', 'tinyobjloader', 'clang')):
        fault(path, number, f"a comment begins with the fragment '{found[1]}'")


for path in subprocess.check_output(['git', 'ls-files'], text=True).split():
    if not path.endswith(SOURCES):
        continue
    before = ''
    for number, line in enumerate(open(path, encoding='utf-8'), 1):
        line = line.rstrip('\n')
        if len(line) > COLUMNS:
            fault(path, number, f'{len(line)} columns, at most {COLUMNS}')
        if path.endswith(('.h', '.cpp')) and '/lessons/' not in path and '/answers/' not in path:
            check_line(path, number, line)
            check_comment(path, number, line, before)
        before = line
if faults:
    sys.exit(f'{faults} faults')
END
