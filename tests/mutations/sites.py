# SPDX-License-Identifier: Apache-2.0
"""Finds places where a C++ file can be changed slightly: relational, logical and arithmetic operators, constants,
neighboring arguments, whole statements.

It reads tokens, not grammar. Comments, strings, preprocessor lines and assertions are skipped.
Spaces distinguish what tokens alone do not: clang-format puts them around binary operators, but not
around template brackets and references."""
import re
from typing import NamedTuple

TOKEN = re.compile(
    r'(?P<skip>//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n\\]|\\.|\\\n)*|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"'
    r'|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\')'
    r"|(?P<number>(?:0[xX][0-9a-fA-F']+|\d[\d']*\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)[uUlLfFzZ]*)"
    r'|(?P<word>[A-Za-z_]\w*)'
    r'|(?P<sign><=>|<<=|>>=|\.\.\.|->\*|->|::|\+\+|--|&&|\|\||[<>=!+\-*/%&|^]=|<<|>>|[^\s\w])',
    re.S | re.M)

BINARY = {'<': ['<=', '>='], '<=': ['<', '>'], '>': ['>=', '<='], '>=': ['>', '<'],
          '==': ['!='], '!=': ['=='], '&&': ['||'], '||': ['&&'], '+': ['-'], '-': ['+'],
          '*': ['/'], '/': ['*'], '%': ['*'], '+=': ['-='], '-=': ['+='], '*=': ['/='],
          '/=': ['*=']}
KIND = {**{o: 'relation' for o in ('<', '<=', '>', '>=', '==', '!=')},
        **{o: 'logic' for o in ('&&', '||')}}
NO_CALL = {'if', 'for', 'while', 'switch', 'return', 'sizeof', 'catch', 'alignof', 'decltype',
           'static_assert', 'assert', 'noexcept', 'requires', 'operator', 'constexpr',
           # the order of arguments does not matter
           'min', 'max', 'minmax', 'hypot', 'angle_between_rad'}
NO_STATEMENT = {'return', 'using', 'namespace', 'case', 'default', 'static_assert', 'template',
                'typedef', 'const', 'constexpr', 'auto', 'friend', 'public', 'private', 'struct',
                'class', 'enum', 'static', 'if', 'for', 'while', 'do', 'switch', 'else', 'try',
                'catch', 'explicit', 'inline', 'virtual', 'goto', 'extern', 'mutable', 'assert'}
# `int tries = 3;` as a member or a parameter: a default for callers, not a computation.
DEFAULT = re.compile(r'^\s*(?!.*(?:constexpr|return))[\w:<>,&* ]+ \w+ = [^;(]*[;,]')


class Token(NamedTuple):
    kind: str
    text: str
    at: int

    @property
    def end(self):
        return self.at + len(self.text)


class Site(NamedTuple):
    kind: str
    at: int
    old: str
    new: str


def tokens_of(text):
    return [Token(m.lastgroup if m.lastgroup != 'mark' else 'skip', m.group(), m.start())
            for m in TOKEN.finditer(text)
            if m.lastgroup not in ('skip', 'mark') or m.group().startswith(('"', 'R"', "'"))]


def between_blanks(text, token):
    return text[token.at - 1].isspace() and text[token.end:token.end + 1].isspace()


def closing(tokens, first):
    """Index of the bracket that closes the one at `first`; None if there is none."""
    depth = 0
    for i in range(first, len(tokens)):
        if tokens[i].text in '([{':
            depth += 1
        elif tokens[i].text in ')]}':
            depth -= 1
            if depth == 0:
                return i
    return None


def other_numbers(number):
    digits = number.replace("'", '')
    whole = re.fullmatch(r'(\d+)([uUlLzZ]*)', digits)
    if whole:
        value = int(whole[1])
        return [f'{v}{whole[2]}' for v in ((value + 1, value - 1) if value > 0 else (1,))]
    real = re.fullmatch(r'([\d.]+(?:[eE][+-]?\d+)?)([fFlL]?)', digits)
    if not real:
        return []
    if float(real[1]) == 0:
        return ['1.0' + real[2]]
    return [f'(2 * {number})', f'(0.5{real[2]} * {number})']


def looks_declared(part):
    """Whether two words are next to each other, as in `int x`."""
    return any(a.kind == 'word' and b.kind == 'word' for a, b in zip(part, part[1:])) or any(
        a.kind == 'word' and b.text in ('&', '*') and c.kind == 'word' and b.at == a.end
        for a, b, c in zip(part, part[1:], part[2:]))


def asserted(tokens):
    """Indices of tokens within assertions and names of operators."""
    inside = set()
    for i, token in enumerate(tokens):
        if token.text in ('assert', 'static_assert', 'noexcept') and i + 1 < len(tokens):
            end = closing(tokens, i + 1) if tokens[i + 1].text == '(' else None
            inside.update(range(i, (end or i) + 1))
        if token.text == 'operator':
            inside.update((i, i + 1, i + 2))
    return inside


def arguments(text, tokens, call):
    """Swaps of neighboring arguments in the call whose name is tokens[call]."""
    end = closing(tokens, call + 1)
    if end is None or looks_declared(tokens[call + 2:end]):
        return
    parts, depth, start = [], 0, call + 2
    for i in range(call + 2, end + 1):
        if depth == 0 and (tokens[i].text == ',' or i == end):
            if i > start:
                parts.append(text[tokens[start].at:tokens[i - 1].end])
            start = i + 1
        depth += (tokens[i].text in '([{') - (tokens[i].text in ')]}')
    at = tokens[call + 2].at if end > call + 2 else 0
    for first, second in zip(parts, parts[1:]):
        at = text.index(first, at)
        old = text[at:text.index(second, at + len(first)) + len(second)]
        if first.split() != second.split() and old.count('\n') <= 2 and '{' not in old:
            yield Site('arguments', at, old,
                       second + old[len(first):len(old) - len(second)] + first)
        at += len(first)


def statements(text, tokens):
    start, brackets = 0, []
    for i, token in enumerate(tokens):
        if token.text in '([{':
            brackets.append(token.text)
        elif token.text in ')]}' and brackets:
            brackets.pop()
        if token.text in '{}':
            start = i + 1
        elif token.text == ')':
            opening = next((j for j in range(i, -1, -1)
                            if tokens[j].text == '(' and closing(tokens, j) == i), 0)
            before = tokens[opening - 1].text if opening else ''
            if before in ('if', 'for', 'while') or (before == 'constexpr'):
                start = i + 1
        elif token.text == 'else':
            start = i + 1
        elif token.text == ';':
            part, start = tokens[start:i], i + 1
            in_head = bool(brackets) and brackets[-1] == '('  # of a for
            if in_head or not part or part[0].text in NO_STATEMENT:
                continue
            old = text[part[0].at:token.end]
            acts = any(t.text in ('(', '=', '+=', '-=', '*=', '/=', '++', '--') for t in part)
            jumps = part[0].text in ('continue', 'break', 'throw')
            level, outside = 0, []
            for t in part:
                level -= t.text in ')]}'
                if level == 0:
                    outside.append(t)
                level += t.text in '([{'
            if level != 0 or old.count('\n') > 5 or (looks_declared(outside) and not jumps):
                continue
            if acts or jumps:
                yield Site('statement', part[0].at, old, '{}' + '\n' * old.count('\n'))


def sites_of(text, header):
    """All small changes of a file, in order."""
    tokens = tokens_of(text)
    passed_over = asserted(tokens)
    found = []
    for i, token in enumerate(tokens):
        if i in passed_over:
            continue
        line = text[text.rfind('\n', 0, token.at) + 1:text.find('\n', token.at)]
        default = header and DEFAULT.match(line)
        before = tokens[i - 1] if i else Token('sign', '', 0)
        if token.kind == 'number' and not default:
            found += [Site('constant', token.at, token.text, n) for n in other_numbers(token.text)]
        elif token.text in ('true', 'false') and not default:
            found.append(Site('constant', token.at, token.text,
                              'false' if token.text == 'true' else 'true'))
        elif token.text in BINARY and between_blanks(text, token):
            found += [Site(KIND.get(token.text, 'arithmetic'), token.at, token.text, new)
                      for new in BINARY[token.text]]
        elif token.text in ('++', '--'):
            found.append(Site('arithmetic', token.at, token.text,
                              '--' if token.text == '++' else '++'))
        elif token.text == '!':
            found.append(Site('logic', token.at, '!', ''))
        elif (token.text == '-' and before.text in ('(', ',', '=', 'return', '{', '?', ':', '*')):
            found.append(Site('arithmetic', token.at, '-', ''))
        elif (token.kind == 'word' and token.text not in NO_CALL and i + 1 < len(tokens)
              and tokens[i + 1].text == '(' and tokens[i + 1].at == token.end):
            found += arguments(text, tokens, i)
    found += [s for s in statements(text, tokens)]
    return sorted(found, key=lambda s: (s.at, s.kind, s.new))


if __name__ == '__main__':
    import sys
    for name in sys.argv[1:]:
        content = open(name).read()
        for site in sites_of(content, name.endswith('.hpp')):
            line_number = content.count('\n', 0, site.at) + 1
            print(f'{name}:{line_number}: {site.kind}: {site.old!r} -> {site.new!r}')
