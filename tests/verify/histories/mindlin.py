"""Closed forms of Cattaneo and Mindlin in the plane: two elastic half planes of one material that touch like cylinders (Hertz), the
normal force P held, then a shear force that changes and returns. README.md has the derivations. Standard library alone.

    python3 mindlin.py                     the self-checks: limits, resultants and slip by quadrature
    python3 mindlin.py tractions TAU       x/a, q/(nu p0) after loading to T = TAU nu P, unloading to 0, reversal to -T
    python3 mindlin.py loop TAU            dissipation of a closed loop between +-T, over nu^2 P^2/E*

Lengths are over a, tractions over nu p0, forces over nu P, slips over nu p0 a/E*, 1/E* = 2 (1 - mu^2)/E for two equal bodies.
"""
import math
import sys


def stick(tau):
    """Half width of the stick zone under T = tau nu P."""
    return math.sqrt(1 - tau)


def traction(x, tau):
    """q after the first loading to tau."""
    x = abs(x)
    c = stick(tau)
    q = math.sqrt(max(0.0, 1 - x*x))
    return q - math.sqrt(c*c - x*x) if x < c else q


def reversed_traction(x, top, tau):
    """q after loading to `top` and going back to tau, -top <= tau <= top: twice the Cattaneo problem of half the change, off."""
    return traction(x, top) - 2*traction(x, (top - tau)/2)


def reverse_stick(top, tau):
    """Half width of what sticks on the way back: from here to 1 the slip goes the other way."""
    return stick((top - tau)/2)


def slip(x, tau):
    """Slip of the first loading, 0 in the stick zone: 2 int_c^x sqrt(t^2 - c^2) dt."""
    x = abs(x)
    c = stick(tau)
    if x <= c:
        return 0.0
    return x*math.sqrt(x*x - c*c) - (c*c*math.acosh(x/c) if c > 0 else 0.0)


def reversed_slip(x, top, tau):
    return slip(x, top) - 2*slip(x, (top - tau)/2)


def loading_work(tau):
    """Dissipation of the first loading, over nu^2 P^2/E*: a quarter of that of the loop, as slip goes twice as far on each way."""
    return loop_work(tau)/4


def loop_work(tau):
    """Dissipation of a closed loop between +-tau, over nu^2 P^2/E*."""
    if tau <= 0:
        return 0.0
    if tau < 1e-3:      # the terms cancel to the third order
        return 2/math.pi*(tau**3/3 + tau**4/6 + tau**5/10)
    rest = 2*(1 - tau)*math.log(1 - tau) if tau < 1 else 0.0
    return 2/math.pi*(tau*(2 - tau) + rest)


def quadrature(f, a, b, n=4000):
    """Of f that has roots at both ends: the midpoint rule in the angle."""
    h = math.pi/n
    return sum(f((a + b)/2 - (b - a)/2*math.cos((k + 0.5)*h))*math.sin((k + 0.5)*h) for k in range(n))*h*(b - a)/2


def require(what, found, expected, tolerance):
    good = abs(found - expected) <= tolerance
    print(f"{what}: {found:.12g}, expected {expected:.12g}" + ("" if good else "   FAILED"))
    return good


def self_check():
    good = True
    for tau in (0.25, 0.5, 0.75):
        c = stick(tau)
        parts = ((0.0, c), (c, 1.0))
        # P is pi/2 a p0
        total = sum(quadrature(lambda x: traction(x, tau), *part) for part in parts)*4/math.pi
        good &= require(f"tau {tau}: resultant", total, tau, 1e-6)
        # work of the friction: nu p times slip, both sides; over nu^2 P^2/E*, P = pi a p0/2
        work = 2*quadrature(lambda x: math.sqrt(1 - x*x)*slip(x, tau), c, 1.0)*4/math.pi**2
        good &= require(f"tau {tau}: dissipation of the loading by quadrature", work, loading_work(tau), 1e-7)
        for back in (0.5*tau, 0.0, -tau):
            b = reverse_stick(tau, back)
            cuts = sorted({0.0, b, c, 1.0})
            total = sum(quadrature(lambda x: reversed_traction(x, tau, back), u, v) for u, v in zip(cuts, cuts[1:]))*4/math.pi
            good &= require(f"tau {tau} back to {back}: resultant", total, back, 1e-6)
        for x in (0.1, 0.6, 0.95):
            good &= require(f"tau {tau}: reversal is complete at {x}", reversed_traction(x, tau, -tau), -traction(x, tau), 1e-14)
            good &= require(f"tau {tau}: slip is reversed at {x}", reversed_slip(x, tau, -tau), -slip(x, tau), 1e-14)
    good &= require("all slips: the loop", loop_work(1.0), 2/math.pi, 1e-15)
    good &= require("a small loop is cubic", loop_work(1e-3*(1 + 1e-12)), loop_work(1e-3*(1 - 1e-12)), 1e-15)
    # B02_cattaneo_unloading.csv
    good &= require("q(0) at tau 0.5", traction(0, 0.5), 0.2928932188, 1e-10)
    good &= require("q(0) after unloading to 0.25", reversed_traction(0, 0.5, 0.25), 0.1637219122, 1e-10)
    good &= require("q(0) after unloading to 0", reversed_traction(0, 0.5, 0), 0.02494402638, 1e-10)
    good &= require("b/a after unloading to 0", reverse_stick(0.5, 0), 0.8660254038, 1e-10)
    return good


def main(words):
    if not words:
        sys.exit(0 if self_check() else 1)
    tau = float(words[1])
    if words[0] == "loop":
        print(f"{loop_work(tau):.12g}")
    elif words[0] == "tractions":
        for k in range(21):
            x = k/20
            values = (traction(x, tau), reversed_traction(x, tau, 0), reversed_traction(x, tau, -tau))
            print(f"{x:.2f} " + " ".join(f"{v:.10f}" for v in values))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
