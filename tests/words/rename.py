#!/usr/bin/env python3
"""Renames identifiers and files of a checkout by lists, for names that are to become the field's words.

usage: rename.py [--tree FOLDER] LIST.tsv...     (default: the checkout that holds this script)

Each line of a list has three fields, separated by tabs:
  SCOPE  '*', or prefixes of paths with commas between them (paths before any file is moved)
  OLD    a whole identifier, or 're:' and a Python regular expression
  NEW    its replacement
or  mv, OLD_PATH, NEW_PATH: a file is moved; includes, CMakeLists.txt and pages follow.
Lines that start with # are comments. All whole identifiers of a file are replaced in one pass, so no rename meets the
result of another. Nothing is committed: look at the difference, then build and run the tests."""
import argparse
import os
import re
import subprocess
import sys

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument('--tree', default=os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..'))
parser.add_argument('lists', nargs='+')
options = parser.parse_args()
tree, lists = os.path.abspath(options.tree), options.lists
moves, rules = [], []
for l in lists:
    for n, line in enumerate(open(l), 1):
        line = line.rstrip('\n')
        if not line.strip() or line.startswith('#'): continue
        f = line.split('\t')
        if len(f) != 3: sys.exit(f'{l}:{n}: want 3 fields: {line!r}')
        if f[0] == 'mv': moves.append((f[1], f[2]))
        else: rules.append((f[0].split(','), f[1], f[2]))
files = subprocess.check_output(['git', 'ls-files'], cwd=tree, text=True).split('\n')
ext = ('.cpp', '.h', '.txt', '.md', '.py', '.sh', '.json', '.js', '.cmake', '.patch', '.html', '.css')
def full(t): # mentions of whole file paths
    for a, b in moves:
        t = re.sub(r'(?<![\w/.-])((?:\.\./)*)' + re.escape(a) + r'(?![\w-])', lambda m: m.group(1) + b, t)
    return t
for f in files:
    p = os.path.join(tree, f)
    if f.startswith('tests/words/'): continue # the lists themselves
    if not f or os.path.islink(p) or not (f.endswith(ext) or f.startswith('.ci/')): continue
    try: t = open(p, encoding='utf-8').read()
    except UnicodeDecodeError: continue
    o, words = t, {}
    for scope, a, b in rules:
        if scope == ['*'] or any(f.startswith(s) for s in scope):
            if a.startswith('re:'): t = re.sub(a[3:], b, t)
            else: words[a] = b
    if words:
        t = re.sub(r'\b(' + '|'.join(sorted(map(re.escape, words), key=len, reverse=True)) + r')\b', lambda m: words[m.group(1)], t)
    t = full(t)
    # CMakeLists of a room name files relative to the room or to its folder
    if os.path.basename(f) == 'CMakeLists.txt' or f.endswith('.md'):
        d = os.path.dirname(f)
        for a, b in moves:
            if d and a.startswith(d + '/') and b.startswith(d + '/'):
                t = re.sub(r'(?<![\w/.-])' + re.escape(a[len(d) + 1:]) + r'(?![\w-])', b[len(d) + 1:], t)
    if t != o: open(p, 'w', encoding='utf-8').write(t)
for a, b in moves:
    if os.path.exists(os.path.join(tree, a)):
        os.makedirs(os.path.dirname(os.path.join(tree, b)), exist_ok=True)
        subprocess.check_call(['git', 'mv', a, b], cwd=tree)
