# SPDX-License-Identifier: MIT
"""Lists sentences that begin with Where, What, Who, Of or Those, which hides who does what.

    sentences.py [FILE...]

Write "if" for a condition, and begin with the one who acts: subject, verb, object. Looked at are
the comments of sources, scripts and makefiles, the strings of src (help, messages, meanings), and the text of
Markdown and of manuals. Prints a line for each, and ends with 1 if there was any. Without FILE it reads all files of
git. A question may begin so, if it has its mark.
"""
import io
import re
import subprocess
import sys
import tokenize

WORDS = r"(?:Where|What|Who|Whoever|Whatever|Wherever|Of|Those)\b"
SENTENCE = re.compile(r"(?:^|(?<=[.!:;] )|(?<=\*\* )|(?<=\| ))[\"“(]?" + WORDS + r"(?![^.!?]*\?)")
HASH = (".py", ".sh", ".mk", ".yml", ".tsv", "Makefile")
SLASH = (".c", ".h", ".cpp", ".js", ".mjs", ".css", ".ts")


def comments_of_c(text):
    """(line, text) of each comment and, as another, of each run of strings."""
    pattern = re.compile(r"/\*.*?\*/|//[^\n]*(?:\n[ \t]*//[^\n]*)*|\"(?:\\.|[^\"\\\n])*\"(?:\s*\"(?:\\.|[^\"\\\n])*\")*|'(?:\\.|[^'\\\n])+'", re.S)
    for match in pattern.finditer(text):
        piece = match.group()
        line = text.count("\n", 0, match.start()) + 1
        if piece.startswith("/*"):
            yield "comment", line, re.sub(r"\n[ \t]*\*+[ \t]?", "\n", piece[2:-2])
        elif piece.startswith("//"):
            yield "comment", line, re.sub(r"(?m)^[ \t]*//+ ?", "", piece)
        elif piece.startswith('"'):
            yield "string", line, re.sub(r'"\s*"', "", piece[1:-1])


def comments_of_hash(text):
    block, start = [], 0
    for number, line in enumerate(text.split("\n") + [""], 1):
        match = re.match(r"[ \t]*# ?(?!!)(.*)|.*[ \t]# (.*)", line)
        if match and match.group(1) is not None:
            start = start if block else number
            block.append(match.group(1))
            continue
        if block:
            yield "comment", start, "\n".join(block)
            block = []
        if match and match.group(2):
            yield "comment", number, match.group(2)


def texts_of_python(text):
    yield from comments_of_hash(text)
    for match in re.finditer(r'"""(.*?)"""', text, re.S):
        yield "comment", text.count("\n", 0, match.start()) + 1, match.group(1)


def texts_of_markdown(text):
    block, start, code = [], 0, False
    for number, line in enumerate(text.split("\n") + [""], 1):
        fence = line.startswith("```")
        code ^= fence
        begins = re.match(r"\s*(?:[-*]|\d+\.) |#|\|", line)
        if block and (begins or fence or code or not line.strip() or line.startswith("    ") and not block):
            yield "text", start, "\n".join(block)
            block = []
        if code or fence or not line.strip() or (line.startswith("    ") and not block):
            continue
        start = start if block else number
        block.append(re.sub(r"^\s*(?:[-*]|\d+\.|#+|\|)\s+", "", line))


def texts_of_roff(text):
    block, start = [], 0
    plain = text.replace("\\-", "-").replace("\\(bu", "")
    plain = re.sub(r"\\f[BIRP]|\\&", "", plain)
    code = tag = False
    for number, line in enumerate(plain.split("\n") + [""], 1):
        if tag:
            # the line behind .TP is no part of the text below it
            tag = False
            continue
        tag = line.startswith((".TP", ".TQ"))
        if line.startswith((".nf", ".EX")):
            code = True
        if line.startswith((".fi", ".EE")):
            code = False
        font = re.match(r"\.(?:B|I|BR|IR|RB|RI|BI|IB) (.*)", line)
        if line.startswith((".\\\"", "'")) or code or not line.strip() or (line.startswith(".") and not font):
            if block:
                yield "text", start, "\n".join(block)
            block = []
            continue
        start = start if block else number
        block.append(font.group(1) if font else line)
    if block:
        yield "text", start, "\n".join(block)


def texts(path, text):
    if path.endswith(".py"):
        return texts_of_python(text)
    if path.endswith(HASH):
        return comments_of_hash(text)
    if path.endswith(SLASH):
        return comments_of_c(text)
    if path.endswith(".md"):
        return texts_of_markdown(text)
    if re.search(r"\.[1-9]$", path):
        return texts_of_roff(text)
    return ()


def main(paths):
    faults = 0
    if not paths:
        paths = subprocess.check_output(["git", "ls-files"], text=True).split("\n")[:-1]
    for path in paths:
        if path.startswith("data/") and not path.startswith("data/farm"):
            continue
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read()
        except (UnicodeDecodeError, FileNotFoundError, IsADirectoryError):
            continue
        for kind, line, piece in texts(path, text):
            if kind == "string" and not path.startswith("src/"):
                continue
            joined = piece if kind == "string" else re.sub(r"\s+", " ", piece).strip()
            found = [match.start() for match in SENTENCE.finditer(joined)]
            # a message begins with a small letter, but so does a part of one
            if kind == "string" and re.match(WORDS.lower() + r" \w+ \w+ \w+", joined) and not joined.startswith("of "):
                found.append(0)
            for start in found:
                faults += 1
                print(f"lint: {path}:{line}: begins so that nobody acts: {joined[start:start + 70]}")
    return 1 if faults else 0


sys.exit(main(sys.argv[1:]))
