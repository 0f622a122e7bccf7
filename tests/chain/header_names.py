"""What a header names and does not reach: names of the standard library, and types of our own headers. No compiler is asked, so that all
headers take a second. A header reaches what it includes itself and what that includes."""

import functools
import re

# Where each name of the standard library that a header may use is declared. A name that is missing here is a fault too: it is added.
STANDARD = {
    "algorithm": "any_of clamp copy copy_n fill fill_n find max min minmax_element move_backward", "array": "array tuple_size_v", "atomic": "atomic", "bitset": "bitset", "bit": "bit_cast bit_ceil", "charconv": "from_chars", "chrono": "chrono",
    "cmath": "abs ceil copysign exp floor hypot ilogb isfinite ldexp log log10 nan round sqrt", "complex": "complex abs",
    "cstddef": "byte ptrdiff_t size_t", "cstring": "memcpy", "exception": "exception_ptr", "cstdint": "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t", "deque": "deque",
    "filesystem": "filesystem", "functional": "function", "future": "async future launch", "initializer_list": "initializer_list",
    "limits": "numeric_limits", "map": "map", "memory": "make_shared shared_ptr unique_ptr", "new": "align_val_t", "numbers": "numbers", "optional": "optional nullopt", "random": "mt19937_64",
    "set": "set", "span": "span as_bytes as_writable_bytes", "stdexcept": "length_error runtime_error", "string": "string to_string",
    "string_view": "string_view", "system_error": "errc error_code", "thread": "thread", "tuple": "tuple",
    "type_traits": "conditional_t invoke_result_t is_integral_v is_same_v is_trivially_copyable_v", "unordered_map": "unordered_map",
    "utility": "declval exchange move pair", "variant": "get get_if holds_alternative monostate variant", "vector": "vector",
}
# Headers that declare what others are for, by the words of the standard.
ALSO = {"cstddef": ["array", "cstdio", "cstring", "functional", "span", "string", "string_view", "vector"], "utility": ["map", "unordered_map"], "system_error": ["charconv"]}
TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)
TYPE = re.compile(r"^(?:template <[^\n]*>\s*)?(?:struct|class|enum class|concept|using)\s+(?:\[\[[^\]]*\]\]\s*)?([A-Z]\w+)\b(?!;)", re.MULTILINE)
LOCAL = re.compile(r"\b(?:struct|class|enum|concept|using|typename)\s+([A-Z]\w+)\b(?!;)")
FORWARD = re.compile(r"^(?:struct|class|enum class)\s+([A-Z]\w+)(?:\s*:\s*\w+)?;", re.MULTILINE)


def where_declared():
    places = {}
    for header, names in STANDARD.items():
        for name in names.split():
            places.setdefault(name, set()).update(f"<{one}>" for one in [header, *ALSO.get(header, [])])
    return places


def unreached(headers, text_of, includes_of):
    """Messages: what a header of `headers` names and does not reach. `text_of`(name) is a header's text; `includes_of`(name) are the pairs
    (quote, included) of it."""
    code = {name: TEXT.sub(" ", text_of(name)) for name in headers}

    @functools.cache
    def reached(name):
        files = {name}
        for quote, included in includes_of(name):
            files |= reached(included) if quote == '"' and included in code else {f"<{included}>"}
        return frozenset(files)

    declared = {}
    for name, text in code.items():
        for one in TYPE.findall(text):
            declared.setdefault(one, set()).add(name)
    standard = where_declared()
    for name, text in code.items():
        for one in sorted(set(re.findall(r"\bstd::(\w+)", text))):
            if one not in standard:
                yield f"{name}: std::{one} stands in no row of STANDARD in tests/chain/header_names.py"
            elif not standard[one] & reached(name):
                yield f"{name}: std::{one} is declared by {' or '.join(sorted(standard[one]))}, which it does not include"
        own = set(LOCAL.findall(text)) | {one for other in reached(name) if other in code for one in FORWARD.findall(code[other])}
        for one in sorted(set(re.findall(r"\b[A-Z]\w+\b", text)) & set(declared) - own):
            if not declared[one] & reached(name):
                yield f"{name}: {one} is declared in {' or '.join(sorted(declared[one]))}, which it does not include"
