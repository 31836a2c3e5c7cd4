"""Translates a compute shader to C++ that kernel.h completes: glsl_to_cpp.py INPUT OUTPUT

The input is a complete shader without preprocessor lines. Own method: GLSL is close enough to C++ that rules on single
tokens suffice for the subset that the shaders use:
- variables in storage blocks and in shared memory become objects whose accesses the simulator sees,
- `precise` becomes a call of precisely(); `float`, `double` and their literals become Float and Double,
- arrays become array<T, N>, swizzles become calls, out parameters become references.
"""
import re
import sys

TOKEN = re.compile(r"[A-Za-z_]\w*|0[xX][0-9a-fA-F]+[uU]?|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?(?:lf|LF|f|F|u|U)?"
                   r"|<<=|>>=|[-+*/%&|^!=<>]=|&&|\|\||\+\+|--|<<|>>|\S")
NAME = re.compile(r"[A-Za-z_]\w*$")
ASSIGNMENTS = {"=", "+=", "-=", "*=", "/=", "|=", "&=", "^=", "<<=", ">>=", "++", "--"}
CLOSING = {"(": ")", "[": "]", "{": "}"}
NOT_TYPES = {"return", "else", "case", "const", "in", "out", "inout", "precise"}


def end_of(tokens, start):
    """The place of the bracket that closes the one at `start`."""
    depth = 0
    for i in range(start, len(tokens)):
        depth += tokens[i] in CLOSING
        depth -= tokens[i] in CLOSING.values()
        if depth == 0:
            return i
    raise ValueError("a bracket is not closed")


def literal(token):
    """A number in C++."""
    if token.lower().endswith("lf"):
        return f"Double({token[:-2]})"
    if re.match(r"0[xX]", token) or not re.search(r"[.eE]", token):
        return token
    return f"Float({token.rstrip('fF')}f)"


class Translator:
    def __init__(self, tokens):
        self.tokens = tokens
        self.memory = {}   # storage and shared variables: True for an array
        self.precise = set()  # the precise variables of the current function
        self.barriers = 0

    def translate(self):
        """The C++ of the whole shader."""
        out = []
        i = 0
        while i < len(self.tokens):
            text, i = self.declaration(i)
            out.append(text)
        return "\n".join(out)

    def declaration(self, i):
        """The C++ of the global declaration at i, and the place after it."""
        tokens = self.tokens
        layout = {}
        qualifiers = set()
        while True:
            if tokens[i] == "layout":
                end = end_of(tokens, i + 1)
                for entry in " ".join(tokens[i + 2:end]).split(" , "):
                    name, _, value = entry.partition(" = ")
                    layout[name] = value
                i = end + 1
            elif tokens[i] in ("coherent", "readonly", "writeonly", "uniform", "buffer", "shared", "in"):
                qualifiers.add(tokens[i])
                i += 1
            else:
                break
        if "in" in qualifiers:
            return f"static const WorkGroupSize work_group_size({layout['local_size_x']});", i + 1
        if "buffer" in qualifiers:
            end = end_of(tokens, i + 1)
            kind, name = tokens[i + 2:i + 4]
            self.memory[name] = tokens[i + 4] == "["
            flags = " | ".join(["0", *sorted(f"k{word.capitalize()}" for word in qualifiers - {"buffer"})])
            return f"static const Storage<{self.type_of(kind)}> {name}({layout['binding']}, {flags}, \"{name}\");", end + 2
        if "shared" in qualifiers:
            end = tokens.index(";", i)
            kind, name = tokens[i:i + 2]
            self.memory[name] = tokens[i + 2] == "["
            count = self.rewrite(tokens[i + 3:end - 1]) if self.memory[name] else "1"
            return f"static const Shared<{self.type_of(kind)}, ({count})> {name}(\"{name}\");", end + 1
        if "uniform" in qualifiers:
            kind, name = tokens[i:i + 2]
            if kind == "usamplerBuffer":
                return f"static const usamplerBuffer {name}{{{layout['binding']}}};", i + 3
            return (f"static {self.type_of(kind)} {name};\n"
                    f"static const UniformPlace {name}_place({layout['location']}, &{name});"), i + 3
        if tokens[i] == "struct":
            end = end_of(tokens, i + 2) + 2
            return self.rewrite(tokens[i:end]), end
        semicolon = tokens.index(";", i)
        brace = tokens.index("{", i) if "{" in tokens[i:] else len(tokens)
        if semicolon < brace:
            return "static " + self.rewrite(tokens[i:semicolon + 1]), semicolon + 1
        return self.function(i, brace)

    def function(self, i, brace):
        """The C++ of the function whose body begins at `brace`. `precise` ends at calls of functions."""
        end = end_of(self.tokens, brace) + 1
        self.precise = set()
        head = self.rewrite(self.tokens[i:brace]).replace("main (", "shaderMain (")
        body = self.rewrite(self.tokens[brace + 1:end])
        return f"static {head} {{ const FunctionScope function_scope; {body}", end

    @staticmethod
    def type_of(token):
        return {"float": "Float", "double": "Double"}.get(token, token)

    def rewrite(self, tokens):
        """The C++ of tokens of a declaration, a statement or an expression."""
        out = []
        i = 0
        while i < len(tokens):
            token = tokens[i]
            before = tokens[i - 1] if i else ";"
            after = tokens[i + 1] if i + 1 < len(tokens) else ";"
            if token in self.memory and before != ".":
                text, i = self.access(tokens, i)
                out.append(text)
            elif token == "precise":
                text, i = self.precise_declaration(tokens, i)
                out.append(text)
            elif token in self.precise and before in (";", "{", "}", ")") and self.assigned(tokens, i):
                equals = self.assigned(tokens, i)
                end = tokens.index(";", equals)
                out.append(f"{self.rewrite(tokens[i:equals])} = "
                           f"precisely([&] {{ return {self.rewrite(tokens[equals + 1:end])}; }})")
                i = end
            elif token in ("out", "inout"):
                i += 1
                if tokens[i + 2:i + 3] == ["["]:
                    end = end_of(tokens, i + 2)
                    out.append(f"array<{self.type_of(tokens[i])}, ({self.rewrite(tokens[i + 3:end])})>& {tokens[i + 1]}")
                    i = end + 1
                else:
                    out.append(f"{self.type_of(tokens[i])}& {tokens[i + 1]}")
                    i += 2
            elif (NAME.match(token) and token not in NOT_TYPES and NAME.match(after) and tokens[i + 2:i + 3] == ["["]):
                end = end_of(tokens, i + 2)
                out.append(f"array<{self.type_of(token)}, ({self.rewrite(tokens[i + 3:end])})> {after}")
                i = end + 1
            elif NAME.match(token) and tokens[i + 1:i + 4] == ["[", "]", "("]:
                out.append(f"makeArray<{self.type_of(token)}>")
                i += 3
            elif token == "." and re.match(r"[xyzw]{2,4}$", after):
                places = ", ".join(str("xyzw".index(letter)) for letter in after)
                out.append(f".swizzle<{places}>()")
                i += 2
            elif token == "barrier":
                self.barriers += 1
                out.append(f"barrier({self.barriers})")
                i = end_of(tokens, i + 1) + 1
            elif token[0].isdigit() or (token[0] == "." and len(token) > 1):
                out.append(literal(token))
                i += 1
            else:
                out.append(self.type_of(token) + ("\n" if token in (";", "{", "}") else ""))
                i += 1
        return " ".join(out)

    def access(self, tokens, i):
        """The C++ of an access to storage or shared memory, and the place after it."""
        name = tokens[i]
        index, end = "0u", i + 1
        if self.memory[name]:
            if tokens[i + 1] != "[":
                return f"{name}.whole()", i + 1
            close = end_of(tokens, i + 1)
            index, end = self.rewrite(tokens[i + 2:close]), close + 1
        if i >= 2 and tokens[i - 1] == "(" and tokens[i - 2].startswith("atomic"):
            kind = "atomic"
        elif (end < len(tokens) and tokens[end] in ASSIGNMENTS) or (i and tokens[i - 1] in ("++", "--")):
            kind = "store"
        else:
            kind = "load"
        return f"{name}.{kind}({index})", end

    def precise_declaration(self, tokens, i):
        """The C++ of a declaration that begins with `precise`, without its semicolon, and the place after it."""
        i += 1
        constant = tokens[i] == "const"
        kind, name = tokens[i + constant:i + constant + 2]
        self.precise.add(name)
        start = i + constant + 2
        if tokens[start] != "=":
            return "", i
        end = tokens.index(";", start)
        kind = self.type_of(kind)
        return (f"{'const ' * constant}{kind} {name} = "
                f"precisely([&]() -> {kind} {{ return {self.rewrite(tokens[start + 1:end])}; }})"), end

    @staticmethod
    def assigned(tokens, i):
        """The place of the = of an assignment that begins at i; None if another statement begins there."""
        i += 1
        while i < len(tokens) and tokens[i] == "[":
            i = end_of(tokens, i) + 1
        return i if i < len(tokens) and tokens[i] == "=" else None


def main():
    text = open(sys.argv[1], encoding="utf-8").read()
    body = Translator(TOKEN.findall(text)).translate()
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write("#include \"lanes/kernel.h\"\nnamespace lanes\n{\nnamespace\n{\n" + body + "\n}\n}\n"
                   "extern \"C\" void lanesMain() { lanes::shaderMain(); }\n")


if __name__ == "__main__":
    main()
