# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Writes a file and its mutants as one text, in which the environment chooses the mutant at run time.

A statement becomes    { if (on(7)) { new } else { old } }
an expression          (on(7) ? (new) : (old)), where both have the same type
an initialiser         T x = on(7) ? T(new) : T(old);

The tokens of the whole file are compared, not its lines. Which of several such places compiles, the compiler says.
"""

import bisect
import re

HEADER = """#pragma once
#include <cstdlib>
#include <type_traits>
namespace taut_mutants {
namespace {
struct Chosen {
    int number = 0;
    Chosen() {
        if (const char* asked = std::getenv("TAUT_MUTANT")) number = std::atoi(asked);
    }
};
__attribute__((init_priority(101))) const Chosen chosen;  // before all else that is not constant
}  // namespace
constexpr bool on(int mutant) { return !__builtin_is_constant_evaluated() && mutant == chosen.number; }
inline bool late(int mutant) { return mutant == chosen.number; }  // in no constant, where on() is false
template <bool allowed>
constexpr int if_allowed(int mutant) {
    static_assert(allowed);
    return mutant;
}
template <class New, class Old>
constexpr bool same = std::is_same_v<std::decay_t<New>, std::decay_t<Old>>;
template <class New, class Old>
constexpr bool numbers = std::is_arithmetic_v<std::decay_t<New>> && std::is_arithmetic_v<std::decay_t<Old>>;
}  // namespace taut_mutants
"""

TOKEN = re.compile(
    r"""//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n\\]|\\.)*\n|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'"""
    r"""|\.?\d(?:[eEpP][+-]|[\w.]|'\d)*|\w+|<<=|<=|>=|==|!=|&&|\|\||\+=|-=|\*=|/=|%=|&=|\|=|\^="""
    r"""|\+\+|--|->|::|\.\.\.|<<|[^\s]""", re.S | re.M)
WORD = re.compile(r"\w")
ASSIGN = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<="}
PRECEDENCE = {"?": 1, ":": 1, "||": 3, "&&": 4, "|": 5, "^": 6, "&": 7, "==": 8, "!=": 8, "<": 9, ">": 9, "<=": 9,
              ">=": 9, "<<": 10, "+": 11, "-": 11, "*": 12, "/": 12, "%": 12}
LEADING = {"return", "if", "else", "for", "while", "do", "switch", "case", "default", "throw", "break", "continue",
           "delete", "goto", "const", "auto", "static", "constexpr", "using", "typedef", "struct", "class", "new",
           "template", "typename", "sizeof", "operator", "friend", "namespace", "public", "private", "inline"}
CLOSES = {"(": ")", "[": "]", "{": "}", "<": ">"}


class Tokens:
    """Those of a text: their words, where they begin, their partners, and which are operators between two things."""

    def __init__(self, text):
        self.words, self.starts, self.ends = [], [], []
        for match in TOKEN.finditer(text):
            word = match.group()
            if word.startswith(("//", "/*")):
                continue
            self.words.append("#" if word.lstrip().startswith("#") else word)
            self.starts.append(match.start())
            self.ends.append(match.end())
        self.binary = [False] * len(self.words)
        self.partner = {}
        stack = []
        for i, word in enumerate(self.words):
            before = self.words[i - 1] if i else ";"
            between = text[self.ends[i] - len(word) - 1:][:1].isspace() and text[self.ends[i]:][:1].isspace()
            if word in PRECEDENCE or word in ASSIGN:
                self.binary[i] = between or word in ("?", ":")
                if word in "+-*&" and not (WORD.match(before[-1]) and before not in LEADING
                                           or before in (")", "]", "}", ">")):
                    self.binary[i] = False
            if word in "([{" or word == "<" and not between:
                stack.append(i)
            elif word in ")]}" or word == ">" and not between:
                while stack and self.words[stack[-1]] == "<" and word != ">":
                    stack.pop()
                if stack and CLOSES[self.words[stack[-1]]] == word:
                    self.partner[stack[-1]] = i
                    self.partner[i] = stack.pop()

    def text(self, begin, end):
        return " ".join(self.words[begin:end])

    def is_block(self, i):
        """Whether the brace at i opens statements, not a list of values."""
        before = self.words[i - 1] if i else ""
        if before == "{":
            return self.is_block(i - 1)
        if before in (")", "]", "const", "noexcept", "override", "else", "do", "try", ";", "}", "mutable"):
            return True
        head = i - 1
        while head >= 0 and self.words[head] not in (";", "{", "}", "(", ")", ","):
            head -= 1
        line = self.words[head + 1:i]
        return any(w in ("namespace", "class", "struct", "->", "enum") for w in line) or self.words[head] == ")" \
            and "=" not in line and "return" not in line and "," not in line

    def is_lambda(self, i):
        before = i - 1
        while before >= 0 and self.words[before] in ("mutable", "const", "noexcept", "auto", "->"):
            before -= 1
        if before >= 0 and self.words[before] == ")" and before in self.partner:
            before = self.partner[before] - 1
        return before >= 0 and self.words[before] == "]"


class Group:
    """Mutants of one place of a file: the tokens [first, last) differ in one of them."""

    def __init__(self, old, mutants):
        self.old, self.mutants = old, mutants  # [(mutant, number, Tokens)]
        count = len(old.words)
        self.first, self.last = count, 0
        for _, _, new in mutants:
            least = min(count, len(new.words))
            same = 0
            while same < least and new.words[same] == old.words[same]:
                same += 1
            tail = 0
            while tail < least - same and new.words[-1 - tail] == old.words[-1 - tail]:
                tail += 1
            self.first, self.last = min(self.first, same), max(self.last, count - tail)
        self.last = max(self.last, self.first)
        self.at = 0
        self.candidates = self.find()

    def name(self):
        return "+".join(m.key for m, _, _ in self.mutants)

    def candidate(self):
        return self.candidates[self.at] if self.at < len(self.candidates) else None

    def parts(self, begin, end):
        """[(number, new words)] and the old words of a place."""
        words = [(n, new.text(begin, end + len(new.words) - len(self.old.words))) for _, n, new in self.mutants]
        return words, self.old.text(begin, end)

    # ---- the three forms ----

    def as_statement(self, begin, end):
        new, old = self.parts(begin, end)
        return "{ " + "".join(f"if (taut_mutants::on({n})) {{ {text} }} else " for n, text in new) + f"{{ {old} }} }}"

    def as_expression(self, begin, end, kind):
        new, old = self.parts(begin, end)
        cast = f"static_cast<std::decay_t<decltype({old})>>" if kind == "numbers" else ""
        text = f"({old})"
        for n, words in reversed(new):
            allowed = f"taut_mutants::if_allowed<taut_mutants::{kind}<decltype({words}), decltype({old})>>({n})"
            text = f"(taut_mutants::on({allowed}) ? {cast}({words}) : {text})"
        return text

    def as_value(self, begin, end, of):
        new, old = self.parts(begin, end)
        return "".join(f"taut_mutants::on({n}) ? static_cast<{of}>({text}) : " for n, text in new) + \
            f"static_cast<{of}>({old})"

    # ---- the places ----

    def valid(self, tokens, begin, end):
        """Whether the tokens are one expression, and stay it in brackets. None, or its weakest operator."""
        words, weakest, asks = tokens.words, 99, 0
        if begin >= end or begin == 0 or end >= len(words):
            return None
        i = begin
        while i < end:
            word = words[i]
            if i in tokens.partner:
                if tokens.partner[i] < i or tokens.partner[i] >= end:
                    return None
                if word == "{" and (i == begin or tokens.is_lambda(i) or not WORD.match(words[i - 1][-1])
                                    and words[i - 1] != ">"):
                    return None
                i = tokens.partner[i] + 1
                continue
            if word in (",", ";", "#", ")", "]", "}", "{") or word in ASSIGN and tokens.binary[i]:
                return None
            if word in LEADING and word not in ("sizeof", "template"):
                return None
            if i > begin and WORD.match(word[0]) and WORD.match(words[i - 1][-1]) and words[i - 1] not in (
                    "template", "sizeof"):
                return None
            if tokens.binary[i]:
                weakest = min(weakest, PRECEDENCE[word])
                asks += {"?": 1, ":": -1}.get(word, 0)
                if asks < 0:
                    return None
            i += 1
        if asks or tokens.binary[begin] or words[begin] in (".", "->", "::", ")", ">", "...") or \
                tokens.binary[end - 1] or words[end - 1] in (".", "->", "::", "!", "-", "template", "operator"):
            return None
        before, after = words[begin - 1], words[end]
        if tokens.binary[begin - 1] and before not in ASSIGN:
            if before not in ("?", ":") and PRECEDENCE[before] >= weakest:
                return None
        elif before not in ("(", "[", "{", ",", ";", "return", ":") and before not in ASSIGN:
            return None
        if tokens.binary[end] and after not in ASSIGN:
            if PRECEDENCE[after] > weakest or after == "?" and weakest == 1:
                return None
        elif after not in (")", "]", "}", ",", ";", ":"):
            return None
        return weakest

    def expressions(self):
        """Valid places, the least first."""
        more = [len(new.words) - len(self.old.words) for _, _, new in self.mutants]
        found = []
        for begin in range(max(1, self.first - 120), self.first + 1):
            for end in range(self.last, min(len(self.old.words), self.last + 120)):
                if self.valid(self.old, begin, end) is None:
                    if end < len(self.old.words) and self.old.words[end] in (";", "#"):
                        break
                    continue
                if all(self.valid(new, begin, end + d) is not None for (_, _, new), d in zip(self.mutants, more)):
                    found.append((begin, end))
        return sorted(set(found), key=lambda place: place[1] - place[0])

    def statements(self):
        """[(begin, end)] of statements that hold all differences and end by a semicolon, the inner first."""
        old, found = self.old, []
        opens = sorted((i for i, j in old.partner.items() if i < self.first and i < j and j >= self.last),
                       reverse=True)
        for brace in opens:
            if old.words[brace] != "{" or not old.is_block(brace):
                continue
            begin = self.first
            for i in opens:  # the outermost bracket within the block
                if i > brace:
                    begin = min(begin, i)
            while begin - 1 > brace:
                before = old.words[begin - 1]
                if before in (";", "#"):
                    break
                if before == "}":
                    other = old.partner.get(begin - 1, 0)
                    if old.is_block(other) and not old.is_lambda(other):
                        break
                begin = min(begin - 1, old.partner.get(begin - 1, begin))
            end = max(self.last, self.first)
            for i in opens:
                if i > brace:
                    end = max(end, old.partner[i] + 1)
            while end < old.partner[brace] and old.words[end] != ";":
                if old.words[end] == "{" and old.is_block(end) and not old.is_lambda(end):
                    end = -1
                    break
                end = max(end, old.partner.get(end, end)) + 1
            if end >= old.partner[brace] or "#" in old.words[begin:end]:
                end = -1
            if end >= 0:
                found += self.without_heads(begin, end + 1)
            if not old.is_lambda(brace):
                break
        return found

    def without_heads(self, begin, end):
        """The statement, and what if, else, for and while stand before; the inner first."""
        words, found = self.old.words, []
        while begin <= self.first:
            found.append((begin, end))
            at = begin
            if words[at] in ("if", "for", "while", "switch"):
                at += 2 if words[at + 1] == "constexpr" else 1
                at = max(at, self.old.partner.get(at, at)) + 1
            elif words[at] in ("else", "do"):
                at += 1
            elif words[at] in ("case", "default"):
                while words[at] != ":":
                    at += 1
                at += 1
            else:
                break
            if at > self.first:
                break
            begin = at
        return [(b, e) for b, e in reversed(found)
                if words[b] not in ("else", "case", "default") and not (e < len(words) and words[e] == "else"
                                                                       and words[b] in ("if", "for", "while"))]

    def declares(self, begin, end):
        """The index of the name that a statement declares, or None."""
        words, i, name = self.old.words, begin, None
        if words[begin] in ("using", "static_assert", "typedef", "template", "struct", "class", "static"):
            return begin
        if words[begin] in LEADING and words[begin] not in ("const", "auto", "constexpr"):
            return None
        while i < end and words[i] not in ("=", "(", "{", ";", "[") and not (
                self.old.binary[i] and words[i] in ASSIGN):
            if words[i] == "<" and i in self.old.partner:
                i = self.old.partner[i] + 1
                continue
            if i > begin and re.match(r"[A-Za-z_]", words[i]) and (
                    words[i - 1] in (">", "&", "*", "&&") and not self.old.binary[i - 1]
                    or WORD.match(words[i - 1][-1])) and words[i - 1] != "template":
                name = i
            i += 1
        if words[begin] in ("const", "auto", "constexpr"):
            return name if name is not None else begin
        return name

    def find(self):
        """[(begin, end, text)], the likeliest first."""
        words, found, last = self.old.words, [], []
        expressions, statements = self.expressions(), self.statements()
        for begin, end in statements:
            if end - begin > 200:
                continue
            name = self.declares(begin, end)
            if name is None:
                outer = any("{" in words[begin:i] and words[i] == ";" for i in range(begin, end - 1))
                (last if outer else found).append((begin, end, self.as_statement(begin, end)))
                continue
            if name <= begin or words[name + 1] != "=" or self.first < name + 2 or "constexpr" in words[begin:name]:
                continue
            of = [w for w in words[begin:name] if w not in ("const", "static")]
            if of == ["auto"] or "auto" in of or "&" in of:
                continue
            depth = [i for i in range(name + 2, end - 1) if words[i] == ","]
            inside = {i for o, c in self.old.partner.items() if name < o < c < end for i in range(o, c)}
            if all(i in inside for i in depth):
                found.append((name + 2, end - 1, self.as_value(name + 2, end - 1, " ".join(of))))
        found += [(b, e, self.as_expression(b, e, "same")) for b, e in expressions]
        found += [(b, e, self.as_expression(b, e, "numbers")) for b, e in expressions
                  if words[b - 1] in ("(", ",", "=") and words[e] in (")", ",", ";")]
        return [instead for place in found + last for instead in self.without_constexpr(*place)]

    def without_constexpr(self, begin, end, text):
        """The place, or in the value of a constexpr variable, which no switch can change, all but constexpr."""
        words, at = self.old.words, begin - 1
        while at > 0 and words[at] not in (";", "}", "constexpr"):
            at -= 1
        if words[at] == "constexpr" and words[at - 1] != "if" and not any(
                words[i] == "{" and self.old.is_block(i) for i in range(at, begin)):
            late = text.replace("taut_mutants::on(", "taut_mutants::late(")
            return [(at, end, f"const {self.old.text(at + 1, begin)} {late}")]
        return [(begin, end, text)]


def rewrite(text, tokens, groups):
    """The text with the present candidate of each group, every line where it was; {line: groups}. Overlapping
    places are returned instead: a pair of groups."""
    places = sorted(((g.candidate(), g) for g in groups if g.candidate()), key=lambda p: p[0][:2])
    for (one, g), (two, h) in zip(places, places[1:]):
        if two[0] < one[1]:
            return None, (g, h)
    out, at, lines = [], 0, {}
    breaks = [i for i, c in enumerate(text) if c == "\n"]
    for (begin, end, new), group in places:
        start, stop = tokens.starts[begin], tokens.ends[end - 1]
        out += [text[at:start], new, "\n" * text.count("\n", start, stop)]
        for line in range(bisect.bisect(breaks, start - 1) + 1, bisect.bisect(breaks, stop - 1) + 2):
            lines.setdefault(line, []).append(group)
        at = stop
    out.append(text[at:])
    return "".join(out), lines
