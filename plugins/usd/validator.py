"""A rule of NVIDIA's validator of USD for the requirement BA.002 of SimReady.

The validator starts `Plugin`, which it finds by an entry point. Its package is no dependency of
satcheck, so nothing else imports this file.
"""

from __future__ import annotations

from typing import Any

import usd_validation_nvidia as validator
from pxr import Tf

from satcheck.core.errors import SatcheckError

_CODE = "com.nvidia.simready.BA.002"


class NonAdjacentCollidersOverlap(validator.BaseRuleChecker):  # type: ignore[misc]  # maybe absent
    """Colliders of links that no joint connects must not overlap.

    A failure is a proven overlap, on the stage as it is open, without a simulation, or says why the
    stage is not read. A warning says what could not be decided.
    """

    def CheckStage(self, usdStage: Any) -> None:
        from satcheck.plugins.usd.links import link_problems, prim_of  # imports all of a check

        requirement = validator.RequirementsRegistry().find_requirement(_CODE)
        try:
            problems = link_problems(usdStage)
        except (SatcheckError, Tf.ErrorException) as error:
            message = f"overlaps could not be decided, the stage is not read: {error}"
            self._AddFailedCheck(message, at=usdStage, requirement=requirement)
            return
        for problem in problems:
            prim = prim_of(problem.bodies[0]) if problem.bodies else None
            at = usdStage.GetPrimAtPath(prim) if prim else usdStage
            if problem.stops:
                message = f"could not be decided: {problem.message}"
                self._AddWarning(message, at=at, requirement=requirement)
            else:
                self._AddFailedCheck(problem.message, at=at, requirement=requirement)


class Plugin:
    def on_startup(self) -> None:
        validator.register_rule("BaseArticulation")(NonAdjacentCollidersOverlap)
        self._listener = validator.add_registry_requirement_callback(_take_requirement)
        _take_requirement()

    def on_shutdown(self) -> None:
        self._listener.unsubscribe()
        validator.unregister_rule(NonAdjacentCollidersOverlap)
        validator.unregister_requirements(NonAdjacentCollidersOverlap)


def _take_requirement() -> None:
    """Make the rule that of the requirement, once SimReady defines it: packages start in any order,
    and simready-validate forgets requirements to load them anew."""
    registry = validator.RequirementsRegistry()
    requirement = registry.find_requirement(_CODE)
    if requirement and not registry.is_registered(NonAdjacentCollidersOverlap, requirement):
        validator.register_requirements(requirement, override=True)(NonAdjacentCollidersOverlap)
