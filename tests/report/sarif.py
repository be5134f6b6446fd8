#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
#
# sarif.py FILE.sarif: checks what SARIF 2.1.0 demands of the parts that we write, and GitHub's limits.
import json
import re
import sys

LEVELS = {'none', 'note', 'warning', 'error'}


def need(condition, text):
    if not condition:
        raise SystemExit('sarif.py: ' + text)


def check_location(location):
    physical = location['physicalLocation']
    uri = physical['artifactLocation']['uri']
    need(re.fullmatch(r"(?:[A-Za-z0-9\-._~/]|%[0-9A-F]{2})+", uri), 'not a relative URI: %r' % uri)
    need(physical['region']['startLine'] >= 1, 'a line below 1')
    for logical in location.get('logicalLocations', []):
        need(set(logical) <= {'name', 'fullyQualifiedName', 'kind'} and len(logical) >= 2, str(logical))


def check_result(result, rules):
    rule = rules[result['ruleIndex']]
    need(rule['id'] == result['ruleId'], 'ruleIndex and ruleId differ')
    need(result['level'] in LEVELS, 'level ' + result['level'])
    need(result['message']['text'], 'no message')
    need(1 <= len(result['locations']) <= 10, 'GitHub takes one to ten locations')
    for location in result['locations']:
        check_location(location)
    prints = result['partialFingerprints']
    need(all(re.fullmatch(r'[0-9a-f]{16}', p) for p in prints.values()) and prints, 'fingerprints')
    need(result.get('baselineState', 'new') in {'new', 'unchanged', 'updated', 'absent'}, 'baselineState')
    need(result['occurrenceCount'] >= 1, 'occurrenceCount')


def main():
    with open(sys.argv[1], encoding='utf-8') as file:
        log = json.load(file)
    need(log['version'] == '2.1.0' and 'sarif-2.1.0' in log['$schema'], 'version')
    need(len(log['runs']) == 1, 'runs')
    run = log['runs'][0]
    driver = run['tool']['driver']
    need(driver['name'] == 'nmtan' and re.fullmatch(r'\d+\.\d+\.\d+', driver['version']), 'driver')
    ids = [rule['id'] for rule in driver['rules']]
    need(len(set(ids)) == len(ids), 'rules are not unique')
    for rule in driver['rules']:
        need(rule['shortDescription']['text'] and rule['fullDescription']['text'] and rule['help']['text'], rule['id'])
        need(rule['help']['markdown'] and re.match(r'[a-z]+:', rule['helpUri']), rule['id'])
        need(len(rule['shortDescription']['text']) <= len(rule['fullDescription']['text']), rule['id'])
        need(rule['defaultConfiguration']['level'] in LEVELS, rule['id'])
    need(len(run['results']) <= 5000, 'too many results')
    for result in run['results']:
        check_result(result, driver['rules'])
    for invocation in run['invocations']:
        need(isinstance(invocation['executionSuccessful'], bool), 'executionSuccessful')
        for notification in invocation['toolExecutionNotifications']:
            need(notification['level'] in LEVELS and notification['message']['text'], 'notification')
    print(len(run['results']))


main()
