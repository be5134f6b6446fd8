#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
#
# schema.py [--lines] SCHEMA DOCUMENT...
#
# Checks JSON documents, or each line of them, against a JSON schema. Knows the part of draft 2020-12 that our schema uses and
# refuses keywords that it does not know, so that nothing in the schema goes unchecked. Also refuses
# duplicate keys and NaN in the documents.
import json
import re
import sys

TYPES = {
    'object': lambda v: isinstance(v, dict),
    'array': lambda v: isinstance(v, list),
    'string': lambda v: isinstance(v, str),
    'boolean': lambda v: isinstance(v, bool),
    'null': lambda v: v is None,
    'number': lambda v: isinstance(v, (int, float)) and not isinstance(v, bool),
    'integer': lambda v: isinstance(v, int) and not isinstance(v, bool),
}
KNOWN = {'$schema', '$defs', '$ref', 'title', 'description', 'type', 'enum', 'const', 'properties', 'required',
         'additionalProperties', 'items', 'minItems', 'maxItems', 'minimum', 'pattern',
         # of draft-04, as SARIF's schema has them
         'id', 'definitions', 'default', 'format', 'maximum', 'anyOf', 'oneOf', 'uniqueItems'}
FORMATS = {
    'uri': r"[A-Za-z][A-Za-z0-9+.-]*:(?:[A-Za-z0-9._~:/?#\[\]@!$&'()*+,;=-]|%[0-9A-Fa-f]{2})*",
    'uri-reference': r"(?:[A-Za-z0-9._~:/?#\[\]@!$&'()*+,;=-]|%[0-9A-Fa-f]{2})*",
    'date-time': r'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(?:\.\d+)?(?:Z|[+-]\d\d:\d\d)',
}


def same(a, b):
    return type(a) is type(b) and a == b


def fits(root, schema, value, path):
    faults = []
    check(root, schema, value, path, faults)
    return not faults


def check(root, schema, value, path, faults):
    unknown = set(schema) - KNOWN
    if unknown:
        raise SystemExit('schema.py: unknown keywords at %s: %s' % (path, sorted(unknown)))
    if '$ref' in schema:
        target = root
        for part in schema['$ref'].removeprefix('#/').split('/'):
            target = target[part]
        check(root, target, value, path, faults)
    if 'type' in schema:
        types = schema['type'] if isinstance(schema['type'], list) else [schema['type']]
        if not any(TYPES[name](value) for name in types):
            faults.append('%s: is %s, expected %s' % (path, json.dumps(value)[:40], ' or '.join(types)))
            return
    if 'enum' in schema and not any(same(value, option) for option in schema['enum']):
        faults.append('%s: %s is not in the list' % (path, json.dumps(value)[:40]))
    if 'const' in schema and not same(value, schema['const']):
        faults.append('%s: is %s, expected %s' % (path, value, schema['const']))
    if 'pattern' in schema and isinstance(value, str) and not re.search(schema['pattern'], value):
        faults.append('%s: %s does not match' % (path, value))
    if 'format' in schema and isinstance(value, str) and not re.fullmatch(FORMATS[schema['format']], value):
        faults.append('%s: %s is no %s' % (path, value, schema['format']))
    for word, right in (('anyOf', lambda n: n >= 1), ('oneOf', lambda n: n == 1)):
        if word in schema and not right(sum(fits(root, part, value, path) for part in schema[word])):
            faults.append('%s: does not fit %s' % (path, word))
    if 'maximum' in schema and TYPES['number'](value) and value > schema['maximum']:
        faults.append('%s: %s is too large' % (path, value))
    if 'minimum' in schema and TYPES['number'](value) and value < schema['minimum']:
        faults.append('%s: %s is too small' % (path, value))
    if schema.get('uniqueItems') and isinstance(value, list):
        texts = [json.dumps(element, sort_keys=True) for element in value]
        if len(set(texts)) != len(texts):
            faults.append('%s: has an element twice' % path)
    if isinstance(value, dict):
        properties = schema.get('properties', {})
        for name in schema.get('required', []):
            if name not in value:
                faults.append('%s: %s is missing' % (path, name))
        for name, member in value.items():
            if name in properties:
                check(root, properties[name], member, path + '/' + name, faults)
            elif schema.get('additionalProperties', True) is False:
                faults.append('%s: %s is not foreseen' % (path, name))
            elif isinstance(schema.get('additionalProperties'), dict):
                check(root, schema['additionalProperties'], member, path + '/' + name, faults)
    if isinstance(value, list):
        if not schema.get('minItems', 0) <= len(value) <= schema.get('maxItems', len(value)):
            faults.append('%s: has %d elements' % (path, len(value)))
        for i, element in enumerate(value):
            if 'items' in schema:
                check(root, schema['items'], element, '%s/%d' % (path, i), faults)


def unique(pairs):
    names = [name for name, _ in pairs]
    if len(set(names)) != len(names):
        raise ValueError('duplicate keys: %s' % names)
    return dict(pairs)


def refuse(word):
    raise ValueError('%s is no JSON' % word)


def main():
    lines = sys.argv[1] == '--lines'
    _, path, *names = [word for word in sys.argv if word != '--lines']
    with open(path, encoding='utf-8') as file:
        schema = json.load(file)
    bad = 0
    for name in names:
        faults = []
        try:
            with open(name, encoding='utf-8') as file:
                for text in file if lines else [file.read()]:
                    document = json.loads(text, object_pairs_hook=unique, parse_constant=refuse)
                    check(schema, schema, document, '', faults)
        except ValueError as error:
            faults.append(str(error))
        for fault in faults[:20]:
            print('%s: %s' % (name, fault))
        bad += bool(faults)
    return 1 if bad else 0


if __name__ == '__main__':
    sys.exit(main())
