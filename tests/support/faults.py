# SPDX-License-Identifier: MIT
"""Faults in lines of C: which a line can have, and a file with all of them, of which NT_FAULT in the environment chooses one.

A statement keeps its line. `return a < b;` becomes `return nt_fault(7) ? (a <= b) : (a < b);`, and a statement for its effect
alone `{ if (nt_fault(8)) { } else { f(); } }`. A fault that changes more of a statement than its expressions has no such form.
A run with NT_MARKS, the name of a file of MARKS bytes, counts in it how often it executes each fault, at most 255 times.
"""
import re

MARKS = 1 << 18  # six times the faults of src

# Before the first line of each file with faults. The system's headers stay away from files that choose what they declare.
SWITCH = r"""#include <sys/syscall.h>
#ifdef __cplusplus
extern "C" {
#endif
char *nt_fault_getenv(const char *) __asm__("getenv");
int nt_fault_atoi(const char *) __asm__("atoi");
long nt_fault_system(long, ...) __asm__("syscall");
#ifdef __cplusplus
}
#endif
static int nt_fault_chosen = -1;
static unsigned char *nt_fault_marks;
__attribute__((constructor, unused)) static void nt_fault_begin(void)
{
	const char *chosen = nt_fault_getenv("NT_FAULT"), *marks = nt_fault_getenv("NT_MARKS");
	const long file = marks && *marks ? nt_fault_system(SYS_openat, -100L, marks, 2L, 0L) : -1;
	const long at = file < 0 ? -1 : nt_fault_system(SYS_mmap, 0L, %dL, 3L, 1L, file, 0L);
	if (file >= 0)
		nt_fault_system(SYS_close, file);
	nt_fault_chosen = chosen ? nt_fault_atoi(chosen) : -1;
	nt_fault_marks = at == -1 ? 0 : (unsigned char *)at;
}
static inline __attribute__((unused)) int nt_fault(int number)
{
	if (__builtin_expect(nt_fault_marks != 0, 0) && nt_fault_marks[number] < 255)
		nt_fault_marks[number]++;
	return number == nt_fault_chosen;
}
""" % MARKS


def quoted(line):
    """For each character whether it stands in a string, a character or a comment."""
    marks, at, inside = [], 0, ''
    while at < len(line):
        c = line[at]
        if not inside and (line.startswith('//', at) or line.startswith('/*', at)):
            return marks + [True] * (len(line) - at)
        if inside and c == '\\':
            marks += [True, True]
            at += 2
            continue
        if c in '"\'' and (not inside or inside == c):
            inside = '' if inside else c
            marks.append(True)
        else:
            marks.append(bool(inside))
        at += 1
    return marks[:len(line)]


SWAPS = [('relational', ' < ', ' <= '), ('relational', ' <= ', ' < '), ('relational', ' > ', ' >= '),
         ('relational', ' >= ', ' > '), ('equality', ' == ', ' != '), ('equality', ' != ', ' == '),
         ('logic', ' && ', ' || '), ('logic', ' || ', ' && '), ('arith', ' + ', ' - '), ('arith', ' - ', ' + '),
         ('arith', ' * ', ' + '), ('arith', ' += ', ' -= '), ('return', 'return true;', 'return false;'),
         ('return', 'return false;', 'return true;')]
STATEMENT = re.compile(r'^(\t+)(?!return|break|continue|goto|case|default|const |static |else|if|for|while|struct |enum )'
                       r'(\*?[a-z_][\w.\[\]>-]*( [-+|&*/^]?= .+|\(.*\)|(\+\+|--)));$')
CHECK = re.compile(r'^(\t+(?:\} else )?(?:else )?if \()(.+)(\)( \{)?)$')
CALL = re.compile(r'(\b[a-z_]\w*\()([a-z_][\w.>\[\]-]*), ([a-z_][\w.>\[\]-]*)(?=[,)])')
BIT_FIELD = re.compile(r'^\t[\w ]+ : \d+;')
NUMBER = re.compile(r'(?<![\w.])(\d+)(?![\w.])')


def mutations(line):
    """All faults that the line can get: (kind, the line with it)."""
    found, text = [], quoted(line)
    for kind, old, new in SWAPS:
        for match in re.finditer(re.escape(old), line):
            if not any(text[match.start():match.end()]):
                found.append((kind, line[:match.start()] + new + line[match.end():]))
    for match in NUMBER.finditer(line):
        if not text[match.start()]:
            found.append(('constant', '%s%d%s' % (line[:match.start()], int(match[1]) + 1, line[match.end():])))
    match = CHECK.match(line)
    if match and match[2].count('(') == match[2].count(')'):
        found.append(('skip check', '%s(%s) && 0%s' % match.group(1, 2, 3)))
    if STATEMENT.match(line) and line.count('(') == line.count(')'):
        found.append(('delete', STATEMENT.match(line)[1] + ';'))
    for match in CALL.finditer(line):
        if not text[match.start()] and match[2] != match[3]:
            found.append(('swap args', line[:match.start()] + '%s%s, %s' % match.group(1, 3, 2) + line[match.end():]))
    return found


def places_in(lines):
    """Numbers of lines that may get a fault: code within functions, not declarations, comments, preprocessor."""
    comment = False
    for number, line in enumerate(lines):
        if comment or line.lstrip().startswith(('/*', '*')):
            comment = '*/' not in line
        elif line.startswith('\t') and not BIT_FIELD.match(line) and mutations(line):
            yield number


# Forms of statements, as clang-format sets them.
WORD = (r'(?:return|break|continue|goto|case|default|else|if|for|while|do|switch|struct|enum|typedef|static|extern|using|'
        r'namespace|class|public|private|template|throw|try|catch|delete|assert|__attribute__|NT_PRINTF\w*)\b')
PLACE = r'(?:\(\*?|\*+)?[A-Za-z_](?:[\w.)]|->|\[[^\[\]]*(?:\[[^\[\]]*\][^\[\]]*)*\])*'
EFFECT = re.compile(r'^(?!%s)%s(?: (?:[-+|&*/^%%]|<<|>>)?= .+|\(.*\)|\+\+|--);$' % (WORD, PLACE))
CONDITION = re.compile(r'^((?:\} )?(?:else )?(if|while|switch) \()(.+)(\)(?: \{|;)?)$')
LOOP = re.compile(r'^for \((.*)(\)(?: \{|;)?)$')
TYPE = re.compile(r'^((?:const |unsigned |struct |enum )*[A-Za-z_][\w:]*(?:<[^;=()]*>)?(?: const)? )'
                  r'([*&]*(?:const )?[A-Za-z_].*);$')
ENDS = re.compile(r'[;}]$|^(case .*|default|\w+):$|^(\} )?(else )?(if|for|while) \(.*\)$')
NAME = re.compile(r'^(\s*[*&]*(?:const )?[A-Za-z_]\w*)(?: = ([^{].*))?$')


def without_comments(line):
    marks = quoted(line)
    for at in range(len(line)):
        if marks[at] and line.startswith(('//', '/*'), at) and all(marks[at:]):
            end = line.find('*/', at) + 2 if line.startswith('/*', at) else 0
            return line[:at].rstrip() + (without_comments(line[end:]) if end > 1 else '')
    return line.rstrip()


def depths(text, brackets='()[]'):
    """How many brackets are open behind each character."""
    depth, found = 0, [0]
    for c, is_text in zip(text, quoted(text)):
        depth += 0 if is_text or c not in brackets else 1 if c in '([{' else -1
        found.append(depth)
    return found


def parts_between(text, separator):
    parts, begin = [], 0
    for at, (c, depth, is_text) in enumerate(zip(text, depths(text, '()[]{}'), quoted(text))):
        if c == separator and not depth and not is_text:
            parts.append(text[begin:at].strip())
            begin = at + 1
    return parts + [text[begin:].strip()]


def pieces_of(statement):
    """(kind, what stays, expressions of which a fault changes one), or None."""
    match = CONDITION.match(statement)
    if match and min(depths(match[3])) == depths(match[3])[-1] == 0:
        return match[2], (match[1], match[4]), [match[3]]
    match = LOOP.match(statement)
    if match:
        parts = parts_between(match[1], ';')
        return ('for', (match[2],), parts) if len(parts) == 3 else None
    if statement.startswith('return ') and statement.endswith(';'):
        return 'return', (), [statement[7:-1]]
    match = TYPE.match(statement)
    if match and not re.match(WORD, re.sub('^(const |struct |enum |unsigned )+', '', statement)):
        names = [NAME.match(part) for part in parts_between(match[2], ',')]
        if all(names) and any(name[2] for name in names):
            return 'declare', (match[1],) + tuple((name[1], bool(name[2])) for name in names), [name[2] or '' for name in names]
    return ('effect', (), [statement]) if EFFECT.match(statement) else None


def fits(other, pieces):
    """Whether a statement with a fault differs from the one without in expressions alone."""
    if not other or other == pieces or other[:2] != pieces[:2] or len(other[2]) != len(pieces[2]):
        return False
    if pieces[0] != 'for' or other[2][0] == pieces[2][0]:
        return True
    begin = pieces_of(pieces[2][0] + ';')
    return bool(begin) and begin[0] == 'declare' and fits(pieces_of(other[2][0] + ';'), begin)


def chosen(plain, others, form='(%s)'):
    """An expression with what stands for it under faults: [(number, expression)]."""
    return ''.join('nt_fault(%d) ? %s : ' % (number, form % text) for number, text in others if text != plain) + form % plain


def with_faults(pieces, faults):
    """The statement with its faults: [(number, pieces)]."""
    kind, frame, plain = pieces
    one = lambda at, form='(%s)': chosen(plain[at], [(number, other[at]) for number, other in faults], form)
    if kind in ('if', 'while', 'switch'):
        return frame[0] + one(0, '(%s)' if kind == 'switch' else '!!(%s)') + frame[1]
    if kind == 'return':
        return 'return %s;' % one(0)
    if kind == 'declare':
        return frame[0] + ', '.join(name + (' = ' + one(at) if valued else '') for at, (name, valued) in enumerate(frame[1:])) + ';'
    if kind == 'effect':
        return '{ %s{ %s } }' % (''.join('if (nt_fault(%d)) { %s } else ' % (n, other[0]) for n, other in faults), plain[0])
    begins = [(number, pieces_of(other[0] + ';')[2]) for number, other in faults if other[0] != plain[0]]
    first = with_faults(pieces_of(plain[0] + ';'), begins)[:-1] if begins else plain[0]
    last = one(2) if any(other[2] != plain[2] for _, other in faults) else plain[2]
    return 'for (%s; %s; %s%s' % (first, one(1, '!!(%s)') if plain[1] else '', last, frame[0])


def statement_at(lines, first):
    """The lines without comments of the statement that begins on a line, or None."""
    parts = []
    for line in lines[first:first + 14]:
        if line.lstrip().startswith('#') or line.endswith('\\'):
            return None
        parts.append(without_comments(line))
        text = ' '.join(part.strip() for part in parts)
        depth, braces = depths(text)[-1], depths(text.lstrip('} '), '{}')[-1]
        if depth < 0 or len(parts) == 1 and not depth and text.endswith(','):
            return None
        if not depth and (text.endswith('{') or not braces and ENDS.search(text)):
            return parts
    return None


def file_with_faults(path, lines, table, left_out):
    """The text of the file with its faults, which are added to the table: [path, line, kind, line with it, first line].

    left_out has numbers of faults, (path, first line of a statement), and (path, -1); a fault that is left out is None.
    """
    usable, out, at = set(places_in(lines)), list(lines), 0
    while at < len(lines):
        first, at = at, at + 1
        text = without_comments(lines[first])
        if not text.startswith('\t') or re.match(r'\s*([{.#"\[*]|/\*|$)', text) or lines[first - 1].endswith('\\'):
            continue
        parts = statement_at(lines, first)
        pieces = parts and pieces_of(' '.join(part.strip() for part in parts))
        if not pieces:
            continue
        at, faults = first + len(parts), []
        fine = not left_out & {(path, first), (path, -1)}
        for number in range(first, at):
            for kind, new in mutations(lines[number]) if number in usable else []:
                changed = [part.strip() for part in parts]
                changed[number - first] = without_comments(new).strip()
                other = ('effect', (), ['']) if kind == 'delete' and len(parts) == 1 else pieces_of(' '.join(changed))
                if fits(other, pieces):
                    if fine and len(table) not in left_out:
                        faults.append((len(table), other[2]))
                    table.append([path, number, kind, new, first] if (len(table), other[2]) in faults[-1:] else None)
        if faults:
            out[first] = re.match(r'\t*', text)[0] + with_faults(pieces, faults)
            out[first + 1:at] = [''] * (len(parts) - 1)
    return SWITCH + '#line 1\n' + '\n'.join(out)
