"""Values: classes whose instances are named fields that never change.

`@frozen` makes of a class what `@dataclass(frozen=True, slots=True)` makes of it, in a twentieth of
the time. A dataclass has eight methods compiled when its module is imported, and a check imports
many more classes than it makes instances of: together they would be half of a start-up. Here all
classes share their methods, and a call of one sets the slots without any `__init__`
(`core/native/bindings/frozen.cpp`).
"""

from __future__ import annotations

from collections.abc import Callable
from operator import attrgetter
from typing import Any, Literal, NoReturn, TypeVar, cast, dataclass_transform, overload

from satcheck.core._native import make_by_fields

T = TypeVar("T")
_DERIVED: Any = object()


def derived(*, init: Literal[False] = False) -> Any:
    """The default of a field that is not given: `__post_init__` sets it, with object.__setattr__.

    init: for type checkers, which know it from dataclasses.
    """
    del init
    return _DERIVED


@overload
def frozen(cls: type[T], /) -> type[T]: ...


@overload
def frozen(*, kw_only: bool) -> Callable[[type[T]], type[T]]: ...


@dataclass_transform(frozen_default=True, field_specifiers=(derived,))
def frozen(cls: type[T] | None = None, /, *, kw_only: bool = False) -> Any:
    """The class with its annotated names as fields, in that order; class attributes are defaults.

    kw_only: they are given by name alone. Instances compare, hash and match by their fields, have
    slots and no other attributes, and call `__post_init__` where there is one. A class has the
    fields that it names itself, not those of a base, and a subclass is called only where it is
    `@frozen` itself.
    """
    if cls is None:
        return lambda named: _frozen(named, kw_only)
    return _frozen(cls, kw_only)


def fields(value: object) -> tuple[str, ...]:
    """The names of the fields of a value, or of its class."""
    return value.__slots__  # type: ignore[attr-defined,no-any-return]


def replace(value: T, /, **changes: Any) -> T:
    """The value with other fields; TypeError for one that it has not."""
    for name in type(value)._given:  # type: ignore[attr-defined]
        if name not in changes:
            changes[name] = getattr(value, name)
    return type(value)(**changes)


def as_dict(value: object) -> dict[str, Any]:
    """Name -> value of each field, values within it likewise."""
    return {name: _plain(getattr(value, name)) for name in fields(value)}


def _plain(value: Any) -> Any:
    if isinstance(value, tuple | list):
        return type(value)(map(_plain, value))
    return as_dict(value) if type(value).__setattr__ is _refuse else value


def _frozen(cls: type[T], kw_only: bool) -> type[T]:
    """The class made again, with slots: they cannot be added to one that exists."""
    names = tuple(cls.__annotations__)
    space = {name: member for name, member in vars(cls).items() if name not in _OF_A_CLASS}
    defaults = {name: space.pop(name) for name in names if name in space}
    given = tuple(name for name in names if defaults.get(name) is not _DERIVED)
    space = _SHARED | space
    space |= {"__slots__": names, "__qualname__": cls.__qualname__}
    space |= {"_given": given, "_values": attrgetter(*names)}
    if not kw_only:
        space["__match_args__"] = given

    metaclass: Any = type(cls)
    made = metaclass(cls.__name__, cls.__bases__, space)
    make_by_fields(made, given, defaults, 0 if kw_only else len(given))
    return cast("type[T]", made)


def _equal(self: Any, other: Any) -> Any:
    if other.__class__ is not self.__class__:
        return NotImplemented
    return self._values(self) == self._values(other)


def _hash(self: Any) -> int:
    return hash(self._values(self))


def _shown(self: object) -> str:
    told = (f"{name}={_brief(getattr(self, name))}" for name in fields(self))
    return f"{type(self).__qualname__}({', '.join(told)})"


def _brief(value: Any) -> str:
    """A mesh file is megabytes of bytes."""
    return f"<{len(value)} bytes>" if isinstance(value, bytes) else repr(value)


def _refuse(self: object, name: str, *_: object) -> NoReturn:
    raise AttributeError(f"{type(self).__name__}.{name}: a value does not change")


def _reduced(self: object) -> tuple[Callable[..., object], tuple[object, ...]]:
    """For copies and pickles: the fields as they are."""
    return _restored, (type(self), *[getattr(self, name) for name in fields(self)])


def _restored(cls: type[T], *values: Any) -> T:
    made: T = object.__new__(cls)
    for name, value in zip(fields(cls), values, strict=True):
        object.__setattr__(made, name, value)
    return made


_OF_A_CLASS = frozenset(("__dict__", "__weakref__"))
_SHARED: dict[str, Any] = {
    "__eq__": _equal,
    "__hash__": _hash,
    "__repr__": _shown,
    "__setattr__": _refuse,
    "__delattr__": _refuse,
    "__reduce__": _reduced,
    "__replace__": replace,  # copy.replace of Python 3.13
}
