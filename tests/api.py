#!/usr/bin/env python3
"""Checks that each public function has a comment that Doxygen finds, and that Doxygen understands all comments.

Public is what a header of a room declares, outside of lessons, of namespaces whose name ends in "detail", and of
private sections. Of that, these need a comment: functions, classes and structs of a namespace, and member functions
whose body stands elsewhere.

These need none: operators; constructors and destructors, which the comment of their class explains; functions that
override another; const members without arguments, which their name explains; and functions with the same name as one
of the same file that has a comment, because overloads share it.
usage: api.py SOURCE_DIR"""

import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

SKIPPED = 77


def has_comment(definition):
    return any(len(definition.find(part)) for part in ('briefdescription', 'detaileddescription'))


def functions_without_comment(compound):
    """Functions that need a comment, of a namespace, class or struct."""
    functions = [member for member in compound.iter('memberdef')
                 if member.get('kind') == 'function' and member.get('prot') == 'public']
    in_namespace = compound.get('kind') == 'namespace'
    own_name = compound.findtext('compoundname').split('<')[0].split('::')[-1].strip()
    explained = {(f.findtext('name'), f.find('location').get('file')) for f in functions if has_comment(f)}
    for function in functions:
        name, arguments = function.findtext('name'), function.findtext('argsstring')
        if name.startswith('operator') or name.lstrip('~') == own_name or function.find('reimplements') is not None:
            continue
        accessor = arguments.startswith('() const')
        if not in_namespace and (function.get('inline') == 'yes' or accessor or arguments.endswith('=default')):
            continue
        if (name, function.find('location').get('file')) not in explained:
            yield function, f'{name}{arguments}'


def faults(folder):
    compounds = [ElementTree.parse(os.path.join(folder, name)).getroot().find('compounddef')
                 for name in os.listdir(folder) if name.endswith('.xml')]
    compounds = [c for c in compounds if c is not None and c.get('kind') in ('namespace', 'class', 'struct')]
    of_namespaces = {c.get('refid') for n in compounds if n.get('kind') == 'namespace' for c in n.iter('innerclass')}
    if not compounds:
        yield 'doxygen found no declarations'
    for compound in compounds:
        found = list(functions_without_comment(compound))
        if compound.get('id') in of_namespaces and not has_comment(compound):
            found.append((compound, compound.findtext('compoundname')))
        for definition, what in found:
            place = definition.find('location')
            yield f"{place.get('file')}:{place.get('line')}: no comment (///) above {what}"


def main():
    if not shutil.which('doxygen'):
        print('api: skipped: doxygen is not installed')
        sys.exit(1 if os.environ.get('CI') else SKIPPED)
    os.chdir(sys.argv[1])
    with tempfile.TemporaryDirectory() as output:
        settings = open('common/api/Doxyfile', encoding='utf-8').read()
        settings += 'GENERATE_HTML = NO\nGENERATE_XML = YES\n'
        run = subprocess.run(['doxygen', '-'], input=settings, text=True, capture_output=True, check=True,
                             env={**os.environ, 'DUET_API_OUTPUT': output, 'DUET_API_VERSION': ''})
        found = sorted(set(run.stderr.splitlines()) | set(faults(os.path.join(output, 'xml'))))
    print('\n'.join(found))
    if found:
        sys.exit(f'{len(found)} faults')


main()
