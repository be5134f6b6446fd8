# SPDX-License-Identifier: MIT
"""Makes one C file of the compute library: amalgamate.py TARGET SOURCE..., from the top folder.

The text of the sources stays as it is, comments too, but for what one translation unit
asks:
- a header comes where it is first included, without the titles of its sections, and all but the API is static;
- names that two files have for their own get the name of their file behind them, and macros of a C file end with it;
- functions that nothing calls and structs that nothing has go, and what macros leave out that are always set (ALWAYS);
- the kernels are compiled once for each instruction set: nmtan.c includes itself, and each time NT_PASS_NAME() makes
  other names of theirs;
- what takes no time in a solve is compiled for size (COLD), and so are the kernels of the processors that few have.
  gcc inlines no function into one of another level of optimization but what it must, so what headers have must be.
"""
import collections
import glob
import os
import re
import sys

HEAD = 'src/api/amalgamation.in'
# Headers that depend on the instruction set: these, and what includes the first.
KERNEL_ROOT, KERNEL_ALSO = 'tangent/fast/turn.h', ['tangent/acos.h']
KERNEL_PLACE = 'src/tangent/fast/kernel_baseline.c'  # among the sources
KERNELS = ['src/tangent/fast/kernel.h', 'src/tangent/sums/kernel.h']

# Files whose functions take no time in a solve: the definition, threads, and what few meshes need.
COLD = re.compile(r'src/(base/(?!hash|structs|scratch|largest)|tangent/(frames|mikktspace|sums/hard)|topology/(orientation|plain)|api/(self|split|vertices))')

# Files that take time in a solve and gain by -O3, as in Makefile. The others are compiled at -O2.
HOT = re.compile(r'src/(base/largest|topology/(adjacency|edge_sort|weld))')
# The same, but vectors would double its code for nothing.
HOT_SCALAR = re.compile(r'src/topology/representatives')

LEVELS = [('@cold', COLD), ('@hot', HOT), ('@scalar', HOT_SCALAR)]

# These leave out what the tool alone needs, and what is for speed where size does not matter.
ALWAYS = r'(?:NT_NO_DEADLINES|NT_NO_HALVES|NT_SMALL_CODE)\n'

# Names that headers of the system declare: a file without them may have them for its own.
SYSTEM = {'link', 'index', 'read', 'write', 'pipe'}

INCLUDE = re.compile(r'#include ([<"])(.+)[>"]')
# The beginning of a function that others see, in the first column.
FUNCTION = re.compile(r'(?!typedef|static|return|else|extern|enum|NMTAN_API|LANE_INLINE|struct \w+ \{)'
	r'[a-z][\w ]*[ *]\**(nt_\w+)\(')
DEFINITION = re.compile(r'^(?:const )?[\w ]+ (nt_\w+)(?:\[\w+\])+(?: = \{.*?^\t*\}+)?;\n', re.M | re.S)
OWN = [re.compile(pattern, re.M) for pattern in (
	r'^(?:static|LANE_INLINE) [^;={(]*?\b(\w+)\(',  # functions
	r'^static [^;={(]*?\b(\w+)(?:\[[^=;]*)? = ',  # constants
	r'^\} (\w+)(?: = .*)?;',  # structs, and variables of one
	r'^[A-Z][A-Z_]+\(([a-z]\w+), [^;\n]*\)$',  # functions that a macro makes
	r'^typedef [^{};(]*?\b(\w+)(?: __attribute__.*)?[;(]',
	r'^typedef (?:struct|enum|union) (\w+) \{')]
ENUM = re.compile(r'^(?:typedef )?enum(?: \w+)? \{(.*?)\}', re.M | re.S)
COMMENT = re.compile(r'/\*.*?\*/', re.S)


def read(path):
	with open(path, encoding='utf-8') as file:
		return file.read()


def own_names(text):
	"""The names that a file defines for itself."""
	plain = COMMENT.sub('', text)
	names = {name for pattern in OWN for name in pattern.findall(plain)}
	for body in ENUM.findall(plain):
		names.update(re.findall(r'(?:^|,)\s*(\w+)', body))
	return names


def includes_of(name):
	return [found[2] for found in map(INCLUDE.match, read('src/' + name).splitlines()) if found and found[1] == '"']


def kernel_headers():
	names = {os.path.relpath(path, 'src') for path in glob.glob('src/tangent/*/*.h')}
	found = {KERNEL_ROOT, *KERNEL_ALSO}
	while True:
		more = {name for name in names - found if found & set(includes_of(name)) - set(KERNEL_ALSO)}
		if not more:
			return found
		found |= more


class Amalgamation:
	def __init__(self, sources):
		self.seen = {'nmtan.h'}
		self.lines = []
		self.level = ''
		self.includes = []
		self.moved = {}  # what headers have external, by name: its definition comes in their place
		counts = {}
		for path in sources + glob.glob('src/t*/**/*.h', recursive=True):
			text = read(path)
			for name in own_names(text):
				counts[name] = counts.get(name, 0) + 1
			if path.endswith('.c'):
				self.moved.update((found[1], 'static ' + found[0]) for found in DEFINITION.finditer(text))
		self.shared = {name for name in counts if (counts[name] > 1 or name in SYSTEM) and not name.startswith('nt_')}

	def lines_of(self, path):
		text = re.sub('#ifdef ' + ALWAYS + r'(.*?)#else\n.*?#endif\n', r'\1', read(path), flags=re.S)
		text = re.sub('#ifndef ' + ALWAYS + r'.*?#endif\n', '', text, flags=re.S)
		for name in self.moved if path.endswith('.c') else ():
			text = text.replace(self.moved[name][len('static '):], '')
		lines = text.splitlines()
		if lines[0].startswith('/* SPDX'):
			lines = lines[1:]
		guard = [i for i, line in enumerate(lines) if re.match(r'#ifndef NT_\w+_H$', line)]
		lines = lines[:guard[0]] + lines[guard[0] + 2:-1] if guard else lines
		return [line for line in lines if not re.match(r'/\* ---- .* ---- \*/$', line)]

	def add(self, path, renamed=()):
		self.lines.append('/* ---- ' + path + ' ---- */')
		depth = 0
		for line in self.lines_of(path):
			depth += bool(re.match(r'#\s*if', line)) - bool(re.match(r'#\s*endif', line))
			included = INCLUDE.match(line)
			if included and included[1] == '"':
				self.add_header(included[2], renamed)
			elif included and depth == 0:
				self.includes += [line] * (line not in self.includes)
			else:
				self.add_line(line, renamed)

	def add_header(self, name, renamed=()):
		if name not in self.seen:
			self.seen.add(name)
			self.add('src/' + name, renamed)

	def add_line(self, line, renamed):
		for pattern, name in renamed:
			line = pattern.sub(name, line)
		if re.search(r'\w \*\w+ = (context|left|given|memory)[;,]', line):
			line = re.sub(r'= (context|left|right|given|memory)([;,])',
				lambda found: '= ({}*){}{}'.format(re.match(r'\s*(.*?)\*', line)[1], found[1], found[2]), line)
		external = re.match(r'extern (?:.* )?(\w+)(?:\[.*\])*;', line)
		if external:
			self.lines += self.moved.get(external[1], '').splitlines()
		else:
			self.lines.append('static ' + line if FUNCTION.match(line) else line)

	def add_source(self, path):
		text = read(path)
		sums = path.startswith('src/tangent/sums/')
		level = next((level for level, files in LEVELS if files.match(path)), '')
		if level and level == self.level and self.lines[-1] == '@warm' and not sums:
			self.lines.pop() # the file before has the same
		else:
			self.lines += ['@sums'] * sums + [level] * bool(level)
		self.level = level
		base = os.path.basename(path)[:-2]
		self.add(path, self.renamed(own_names(text) & self.shared, base))
		self.lines += ['#undef ' + name for name in re.findall(r'^#define (\w+)', text, re.M)
			if self.is_elsewhere(name, path)]
		self.lines += ['@warm'] * bool(level) + ['#endif'] * sums

	@staticmethod
	def renamed(names, owner):
		return [(re.compile(r'(?<![\w.])(?<!->)' + name + r'\b'), name + '_of_' + owner) for name in sorted(names)]

	@staticmethod
	def is_elsewhere(name, path):
		others = set(glob.glob('src/[abt]*/**/*.[ch]', recursive=True)) - {path}
		return any(re.search(r'\b' + name + r'\b', read(other)) for other in others)

	def add_kernels(self):
		headers = kernel_headers()
		for name in sorted(headers):
			for other in includes_of(name):
				if other not in headers:
					self.add_header(other)
		texts = [read('src/' + name) for name in sorted(headers)]
		clashes = {}
		for path in KERNELS:
			others = set().union(*(own_names(read('src/' + name)) for name in headers if 'src/' + name != path))
			clashes[path] = self.renamed(own_names(read(path)) & others, os.path.basename(os.path.dirname(path)))
		names = sorted(set().union(*map(own_names, texts), *({name for _, name in renamed} for renamed in clashes.values())))
		self.lines += ['', '/* ---- names of the kernels ---- */']
		self.lines += ['#define {0} NT_PASS_NAME({0})'.format(name) for name in names]
		self.lines += ['', '#define NT_KERNEL NT_PASS_NAME(nt_kernels)',
			'#define NT_SUM_KERNEL NT_PASS_NAME(nt_sum_kernels)']
		self.lines += ['@passes']
		for path in KERNELS:
			self.seen.add(path[len('src/'):])
			self.lines += ['@sums'] * ('/sums/' in path)
			self.add(path, clashes[path])
			self.lines += ['#endif'] * ('/sums/' in path)
		macros = {}
		for name, value in re.findall(r'^#define (\w+)((?:.*\\\n)*.*)', '\n'.join(texts), re.M):
			macros.setdefault(name, set()).add(value)
		self.lines += ['#undef ' + name for name in sorted(macros) if len(macros[name]) > 1]
		self.lines += ['@rest']

	def text(self):
		"""All of it, without what nothing uses, and without lines that are empty for nothing."""
		text = '\n'.join(self.lines) + '\n'
		while True:
			plain = COMMENT.sub('', text)
			heads = re.findall(r'^static [^;={(]*?\b(\w+)\(', plain, re.M)
			heads, words = collections.Counter(heads), collections.Counter(re.findall(r'\w+', plain))
			unused = [name for name in heads if words[name] == heads[name]]
			types = [name for name in re.findall(r'^typedef struct (\w+) \{', plain, re.M) if words[name] == 2]
			for name in unused:
				text = re.sub(r'(?:^/\*(?:(?!\*/).)*\*/\n)?^static [^;={}()]*\b' + name +
					r'\([^{};]*\)(?:;\n|\n\{\n.*?^\}\n)', '', text, flags=re.M | re.S)
			for name in re.findall(r'^enum \{ (\w+) = [^,}]* \};', plain, re.M):
				if words[name] == 1:
					text = re.sub(r'(?:^/\*(?:(?!\*/).)*\*/\n)?^enum \{ ' + name + ' = .*\n', '', text, flags=re.M)
			for name in types:
				text = re.sub(r'(?:^/\*(?:(?!\*/).)*\*/\n)?^typedef struct ' + name + r' \{[^}]*\} ' + name + ';\n',
					'', text, flags=re.M | re.S)
			if not unused:
				text = re.sub(r'^static inline ', 'NT_INLINE ', text, flags=re.M)
				return re.sub(r'\n\n+(?=/\* ---- )', '\n', re.sub(r'\n\n\n+', '\n\n', text))


def main():
	target, sources = sys.argv[1], sys.argv[2:]
	result = Amalgamation(sources)
	for path in sources:
		if path == KERNEL_PLACE:
			result.add_kernels()
		else:
			result.add_source(path)
	text = read(HEAD)
	licence = ''.join((' * ' + line).rstrip() + '\n' for line in read('LICENSE').splitlines())
	text = text.replace('@licence\n', licence).replace('@includes\n', '\n'.join(result.includes) + '\n')
	body = result.text()
	for name in ('passes', 'rest', 'cold', 'hot', 'scalar', 'warm', 'sums'):
		part = re.search('@begin ' + name + '\n(.*?)@end\n', text, re.S)
		text = text.replace(part[0], '')
		body = body.replace('@' + name + '\n', part[1])
	with open(target + '.part', 'w', encoding='utf-8') as file:
		file.write(text + body + '#endif\n')
	os.replace(target + '.part', target)


main()
