# SPDX-License-Identifier: MIT
"""Makes manual pages of the functions of nmtan.h: man3.py HEADER FOLDER.

The comment in front of a function is its page; the structs and enums of its arguments follow as they stand. nmtan.3 has
what the header says at its begin and its end.
"""
import os
import re
import sys

FUNCTION = re.compile(r'/\*((?:(?!\*/).)*)\*/\nNMTAN_(?:API|INLINE) ([^;{]*?\b(nmtan_\w+)\([^;{]*\))(?:;|\n\{)', re.S)
TYPE = re.compile(r'((?:/\*(?:(?!\*/).)*\*/\n)?typedef (?:struct|enum) (nmtan_\w+) \{\n.*?\n\} \2;)', re.S)


def escape(line):
	line = line.replace('\\', '\\e').replace('-', '\\-')
	return '\\&' + line if line[:1] in ".'" else line


def strip(comment):
	"""The lines of a comment without its border."""
	return [re.sub(r'^ ?\*? ?', '', line).rstrip() for line in comment.strip('\n ').split('\n')]


def verbatim(lines):
	return ['.PP', '.nf'] + [escape(line.expandtabs(8)) for line in lines] + ['.fi']


def prose(lines):
	"""Paragraphs are filled; what is set in stays as it stands."""
	made, block = [], []
	for line in lines + ['']:
		if line.startswith('  '):
			block.append(line)
			continue
		if block:
			made += verbatim(block)
			block = []
		if line.startswith('- '):
			made += ['.IP \\(bu 2', escape(line[2:])]
		else:
			made += [escape(line.strip())] if line else ['.PP']
	while made and made[-1] == '.PP':
		made.pop()
	return made


def page(name, version, summary, synopsis, description, types, others):
	lines = [f'.TH {name.upper()} 3 "" "nmtan {version}" "Library functions"', '.SH NAME', f'{name} \\- {escape(summary)}',
		'.SH SYNOPSIS', '.nf', '#include <nmtan.h>', ''] + [escape(line.expandtabs(8)) for line in synopsis] + ['.fi']
	lines += ['.SH DESCRIPTION'] + description
	if types:
		lines += ['.SH TYPES']
		for text in types:
			lines += verbatim(text.split('\n'))
	lines += ['.SH SEE ALSO', ',\n'.join(f'.BR {other} (3)' for other in others).replace(',\n.BR', ' ,\n.BR')]
	return '\n'.join(lines) + '\n'


def summary_of(lines):
	"""The first sentence, as a part of one."""
	text = re.split(r'(?<=[a-z)"])[.:](?:\s|$)', ' '.join(lines).strip())[0].strip()
	return text[0].lower() + text[1:]


def types_of(declaration, types):
	"""The parts of its arguments, in the order of the header."""
	used, more = set(), declaration
	while more:
		found = set(re.findall(r'\bnmtan_\w+', re.sub(r'/\*.*?\*/', '', more, flags=re.S))) & set(types) - used
		used |= found
		more = ' '.join(types[name] for name in found)
	return [types[name] for name in types if name in used]


def main():
	header, folder = sys.argv[1:]
	with open(header, encoding='utf-8') as file:
		text = file.read()
	version = re.search(r'VERSION_STRING "(.*)"', text)[1]
	types = {name: whole for whole, name in TYPE.findall(text)}
	functions = [(strip(comment), declaration, name) for comment, declaration, name in FUNCTION.findall(text)]
	names = [name for _, _, name in functions]
	declared = re.findall(r'^NMTAN_(?:API|INLINE) .*?\b(nmtan_\w+)\(', text, re.M)
	if names != declared:
		sys.exit(f'{header}: no comment in front of {set(declared) - set(names)}')
	pages = {}
	for comment, declaration, name in functions:
		pages[name] = page(name, version, summary_of(comment), (declaration + ';').split('\n'), prose(comment),
			types_of(declaration, types),
			['nmtan'] + [other for other in names if other != name])
	head, end = (strip(found) for found in (re.search(r'\n/\*\n(.*?)\*/', text, re.S)[1],
		re.search(r'/\* ---- the contract ----\n(.*?)\*/', text, re.S)[1]))
	pages['nmtan'] = page('nmtan', version, 'tangent frames for normal-mapped meshes', [],
		prose(head[1:]) + ['.SH CONTRACT'] + prose(end), [], names)
	os.makedirs(folder, exist_ok=True)
	for name in pages:
		with open(os.path.join(folder, name + '.3'), 'w', encoding='utf-8') as file:
			file.write('.\\" SPDX-License-Identifier: MIT\n' + pages[name])


main()
