"""Formulas of x, y, r and the like as texts, from parameter files and command lines."""

import ast
import math
import operator

import numpy as np

from .errors import InputError

_OPERATORS = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Lt: operator.lt,
    ast.Gt: operator.gt,
    ast.LtE: operator.le,
    ast.GtE: operator.ge,
}
_MATHEMATICS = {
    "pi": math.pi,
    "abs": np.abs,
    "sqrt": np.sqrt,
    "exp": np.exp,
    "log": np.log,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "atan2": np.arctan2,
    "min": np.minimum,
    "max": np.maximum,
}


def evaluate(formula, names):
    """Arithmetic with the given names and functions, and nothing else: cases come from anywhere."""
    names = {**_MATHEMATICS, **names}

    def value(node):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float, str)):
            return node.value
        if isinstance(node, ast.Name) and node.id in names:
            return names[node.id]
        if isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
            return _OPERATORS[type(node.op)](value(node.operand))
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            return _OPERATORS[type(node.op)](value(node.left), value(node.right))
        if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _OPERATORS:
            return _OPERATORS[type(node.ops[0])](value(node.left), value(node.comparators[0]))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and callable(names.get(node.func.id)):
            return names[node.func.id](
                *(value(argument) for argument in node.args),
                **{keyword.arg: value(keyword.value) for keyword in node.keywords},
            )
        raise InputError(f'cannot evaluate "{ast.unparse(node)}"; known names are {", ".join(sorted(names))}')

    try:
        tree = ast.parse(formula.strip().replace("^", "**"), mode="eval")
    except SyntaxError as error:
        raise InputError(f'"{formula}" is no formula: {error.msg}') from None
    try:
        return value(tree.body)
    except TypeError as error:
        raise InputError(f'"{formula}": {error}') from None
