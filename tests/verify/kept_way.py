"""The ways of the checker for tests that ask it thousands of times about one motion: a step that has been
taken is not taken again."""
from stabilab.verify.spin_up import Way

MOST = 64  # motions


def keeping():
    """A class in the place of `Way`, with steps of its own to keep. A step follows from the start and from
    the times asked for so far."""
    kept = {}

    class KeptWay(Way):
        def __init__(self, rates, state, bits, allowed):
            super().__init__(rates, state, bits, allowed)
            if len(kept) >= MOST:
                kept.pop(next(iter(kept)))
            start = *(tuple(part) for part in (rates.kappa, rates.rho, rates.sigma, rates.m,
                                               state)), bits, allowed
            self.later = kept.setdefault(start, {})

        def _step(self, t):
            if t not in self.later:
                super()._step(t)
                self.later[t] = (self.t, self.steps, self.centre, self.P, self.box), {}
            (self.t, self.steps, self.centre, self.P, self.box), self.later = self.later[t]

    return KeptWay
