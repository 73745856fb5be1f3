"""The exact values of the stability table, apart from the program: `python3 exact.py` evaluates the expressions of the first
column of exact.tsv with 250 digits and writes 50 of them; integrals have 40. Needs mpmath. A number in an expression is the double nearest to
it, mpf('...') that decimal; single() and double() round."""
import ast
import pathlib
import struct

from mpmath import cos, exp, expm1, log, log1p, mp, mpc, mpf, nstr, pi, quad, sin, sqrt

mp.dps = 250


def double(x):
    return mpf(float(x))


def single(x):
    return mpf(struct.unpack("f", struct.pack("f", float(x)))[0])


def fresnel(c, eta):
    """Reflectance; eta = index beyond over index before."""
    square = 1 - (1 - c * c) / eta**2
    if square <= 0:
        return mpf(1)
    t = sqrt(square)
    return (((c - eta * t) / (c + eta * t)) ** 2 + ((eta * c - t) / (eta * c + t)) ** 2) / 2


def moment(eta, power):
    """int_0^1 F(mu; 1 / eta) mu^power dmu, from inside; mu = edge + t^2 takes the root away."""
    edge = sqrt(1 - 1 / eta**2) if eta > 1 else mpf(0)
    with mp.workdps(60):
        rest = quad(lambda t: 2 * t * fresnel(edge + t * t, 1 / eta) * (edge + t * t) ** power, [0, sqrt(1 - edge) / 8, sqrt(1 - edge)])
    return edge ** (power + 1) / (power + 1) + rest


def external(n):
    """F_ext in closed form, n > 1."""
    return (mpf(1) / 2 + (n - 1) * (3 * n + 1) / (6 * (n + 1) ** 2)
            + n**2 * (n**2 - 1) ** 2 / (n**2 + 1) ** 3 * log((n - 1) / (n + 1))
            - 2 * n**3 * (n**2 + 2 * n - 1) / ((n**2 + 1) * (n**4 - 1))
            + 8 * n**4 * (n**4 + 1) / ((n**2 + 1) * (n**4 - 1) ** 2) * log(n))


def classic(s, a, eta):
    """z_r, z_v, sigma_tr, weights of fluence and flux."""
    t = s + a
    f = 2 * moment(eta, 1)
    z = 1 / t
    return z, z * (1 + 4 * (1 + f) / (1 - f) / 3), sqrt(3 * a * t), mpf(0), s / t / (4 * pi)


def better(s, a, eta):
    t = s + a
    c1, c2 = moment(eta, 1), moment(eta, 2)
    d = (2 * a + s) / (3 * t * t)
    strength = (s / t) ** 2 / (4 * pi)
    return (1 / t, 1 / t + 4 * (1 + 3 * c2) / (1 - 2 * c1) * d, sqrt(a / d), strength * (1 - 2 * c1) / (4 * d),
            strength * (1 - 3 * c2) / 2)


def profile(dipole, r):
    zr, zv, k, phi, flux = dipole
    dr, dv = sqrt(r * r + zr * zr), sqrt(r * r + zv * zv)
    return (phi * (exp(-k * dr) / dr - exp(-k * dv) / dv)
            + flux * sum(z * (1 + k * d) * exp(-k * d) / d**3 for z, d in ((zr, dr), (zv, dv))))


def tail(dipole, a):
    zr, zv, k, phi, flux = dipole
    dr, dv = sqrt(a * a + zr * zr), sqrt(a * a + zv * zv)
    fluence = (exp(-k * dr) - exp(-k * dv)) / k
    return 2 * pi * (phi * fluence + flux * (zr * exp(-k * dr) / dr + zv * exp(-k * dv) / dv))


def henyey(c, g):
    return (1 - g * g) / (4 * pi * (1 + g * g - 2 * g * c) ** mpf(1.5))


def lobe(g, q):
    """The cosine of Henyey and Greenstein's function within which the share q lies."""
    f = (1 - g * g) / (1 - g + 2 * g * (1 - q))
    return (1 + g * g - f * f) / (2 * g)


def once(depth, light, view):
    """Scattered once and transmitted, over E p."""
    return light / (light - view) * (exp(-depth / light) - exp(-depth / view))


def twice(depth, light, view):
    """The same of two scatterings, of which the second is anywhere along the way."""
    k = 1 / light - 1 / view
    e = exp(-k * depth)
    return exp(-depth / view) / (2 * view) * (depth / view * (1 - e) / k + (1 - (1 + k * depth) * e) / k)


def minor(ax, ay, bx, by):
    """The smaller singular value of the columns (ax, ay), (bx, by)."""
    s, d = ax * ax + ay * ay + bx * bx + by * by, ax * by - ay * bx
    return sqrt((s - sqrt(s * s - 4 * d * d)) / 2)


class mie:
    """A sphere, by the formulas of [BohrenHuffman1983] in 250 digits, which upward recurrences may lose."""

    def __init__(self, x, real, imaginary):
        m = mpc(real, imaginary)
        z = m * x
        orders = int(x + 4.05 * x ** mpf(1 / 3) + 8) if x > 1e-2 else 4
        psi, chi, inner = [sin(x), sin(x) / x - cos(x)], [cos(x), cos(x) / x + sin(x)], [sin(z), sin(z) / z - cos(z)]
        for n in range(1, orders):
            psi.append((2 * n + 1) / x * psi[n] - psi[n - 1])
            chi.append((2 * n + 1) / x * chi[n] - chi[n - 1])
            inner.append((2 * n + 1) / z * inner[n] - inner[n - 1])
        a, b = [0], [0]
        for n in range(1, orders + 1):
            xi, xi_before = mpc(psi[n], -chi[n]), mpc(psi[n - 1], -chi[n - 1])
            dpsi, dxi, dinner = psi[n - 1] - n / x * psi[n], xi_before - n / x * xi, inner[n - 1] - n / z * inner[n]
            a.append((m * inner[n] * dpsi - psi[n] * dinner) / (m * inner[n] * dxi - xi * dinner))
            b.append((inner[n] * dpsi - m * psi[n] * dinner) / (inner[n] * dxi - m * xi * dinner))
        square = lambda c: c.real**2 + c.imag**2
        dot = lambda p, q: p.real * q.real + p.imag * q.imag
        self.ext = 2 / x**2 * sum((2 * n + 1) * (a[n] + b[n]).real for n in range(1, orders + 1))
        self.sca = 2 / x**2 * sum((2 * n + 1) * (square(a[n]) + square(b[n])) for n in range(1, orders + 1))
        self.abs = self.ext - self.sca
        self.g = 4 / x**2 / self.sca * sum(
            mpf(2 * n + 1) / (n * (n + 1)) * dot(a[n], b[n])
            + (mpf(n * (n + 2)) / (n + 1) * (dot(a[n], a[n + 1]) + dot(b[n], b[n + 1])) if n < orders else 0)
            for n in range(1, orders + 1))


class Numbers(ast.NodeTransformer):
    """Every number becomes the mpf of its double."""

    def visit_Constant(self, node):
        if isinstance(node.value, str):
            return node
        return ast.copy_location(ast.Call(ast.Name("mpf", ast.Load()), [ast.Constant(float(node.value))], []), node)


def evaluate(text):
    return eval(compile(ast.fix_missing_locations(Numbers().visit(ast.parse(text, mode="eval"))), text, "eval"), globals())


if __name__ == "__main__":
    path = pathlib.Path(__file__).parent / "exact.tsv"
    lines = [line.split("\t")[0] for line in path.read_text().splitlines() if line]
    path.write_text("".join(f"{line}\t{nstr(evaluate(line), 50)}\n" for line in lines))
