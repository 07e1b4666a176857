"""The signature of a compiled class for `inspect.signature`, from the text that nanobind keeps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import inspect


class Signature:
    """Descriptor for `__signature__` of a class. The signature is made at the first access."""

    def __get__(self, instance: object, owner: Any) -> inspect.Signature:
        import ast
        import inspect

        (overload,) = owner.__init__.__nb_signature__
        function = ast.parse(f"{overload[0]}: ...").body[0]
        assert isinstance(function, ast.FunctionDef)
        return inspect.Signature(
            [
                inspect.Parameter(
                    argument.arg,
                    inspect.Parameter.POSITIONAL_OR_KEYWORD,
                    annotation=ast.unparse(argument.annotation),
                )
                for argument in function.args.args
                if argument.annotation is not None  # self has none
            ]
        )
