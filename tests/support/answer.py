# SPDX-License-Identifier: MIT
"""answer.py --serve FOLDER: runs the Python programs of one shell script, each in a fork of this process, which takes a
fiftieth of the time of a new Python. See `ask` in cli.sh."""
import base64  # noqa: F401 what they import
import json  # noqa: F401
import math  # noqa: F401
import os
import re  # noqa: F401
import signal
import struct  # noqa: F401
import subprocess  # noqa: F401
import sys
import traceback
import urllib.parse  # noqa: F401
import zlib  # noqa: F401

texts = {}


def text_of(words):
    """The program that python3 would run with these words."""
    if words[0] == '-':
        return sys.stdin.read()
    if words[0] == '-c':
        return words.pop(1)
    if words[0] not in texts:
        with open(words[0], encoding='utf-8') as file:
            texts[words[0]] = compile(file.read(), words[0], 'exec')
    return texts[words[0]]


def run(caller, folder, words):
    for name, fd in (('out', 1), ('err', 2)):
        os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_APPEND), fd)
    os.dup2(os.open('/proc/%s/fd/0' % caller, os.O_RDONLY | os.O_NONBLOCK), 0)
    os.chdir(folder)
    os.set_blocking(0, True)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    text = text_of(words)
    sys.argv = words
    sys.path.insert(0, os.path.dirname(words[0]))
    exec(text, {'__name__': '__main__', '__file__': words[0]})


def status_of(*request):
    try:
        run(*request)
        return 0
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
            return 1
        return int(end.code or 0)
    except BaseException:
        traceback.print_exc()
        return 1


sys.dont_write_bytecode = True
os.chdir(sys.argv[2])
with open('pid', 'w') as file:
    file.write(str(os.getpid()))
while True:
    with open('ask', 'rb') as file:
        caller, folder, *words = [os.fsdecode(word) for word in file.read().split(b'\0')[:-1]]
    if words[0][0] != '-' and os.path.exists(words[0]):
        text_of(words)  # for all who come later
    child = os.fork()
    if child == 0:
        status = status_of(caller, folder, words)
        try:
            sys.stdout.flush()
        except OSError:
            status = 1
        os._exit(status)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    with open('said', 'w') as file:
        file.write('%d\n' % (status if status >= 0 else 128 - status))
