"""Random chains of 3 to 10 spins, twelve families of them: each as a config and as dense matrices.

With x the spins in one row of numbers (site by site x, y, z; meV, mu_B, T, nm)

    E = x A x / 2 − b x − Σ K₂ (m·e)⁴ + Σ K_c (a₁²a₂² + a₂²a₃² + a₃²a₁²)

where exchange, Dzyaloshinskii–Moriya, axes and dipoles are in A, the field in b, and a are the components of m along cubic axes. All
functions take many states at once: arrays (states, sites, 3).
"""

import numpy as np
from scipy.special import zeta

# CODATA 2022: meV/T; and mu_0 mu_B²/4π nm³ in meV
MU_B = 5.7883817982e-2
DIPOLE = 1.25663706127e-6 / (4 * np.pi) * MU_B**2 * 1.602176634e-19 * 1e-3 / 1e-27


def unit(v):
    return np.asarray(v, float) / np.linalg.norm(v)


class Chain:
    """A config that grows term by term, and the matrices of the same energy."""

    def __init__(self, sites, moments=None, periodic=False, spacing=None, vacant=()):
        self.sites, self.periodic, self.spacing = sites, periodic, spacing
        self.moments = np.full(sites, 2.0) if moments is None else np.asarray(moments, float)
        self.vacant, self.frozen = set(vacant), {}
        self.a, self.b = np.zeros((sites, 3, sites, 3)), np.zeros((sites, 3))
        self.quartic, self.cubic = [], []
        # the axis about which every rotation leaves the energy as it is
        self.axis = None
        chain = {"sites": sites, "periodic": periodic}
        if self.vacant:
            chain["vacant"] = sorted(self.vacant)
        chain["moments"] = [{"sites": list(range(sites)), "moment": [f"{x} mu_B" for x in self.moments.tolist()]}]
        if spacing:
            chain["spacing"] = f"{spacing} nm"
        self.config = {
            "name": "chain",
            "material": {"name": "random", "source": "random numbers", "moment": "2 mu_B", "energy": []},
            "lattice": {"chain": chain},
            "energy": [],
        }

    def add(self, term, **values):
        self.config["energy"].append({term: values})

    def freeze(self, site, direction):
        self.frozen[site] = unit(direction)
        self.config["lattice"]["chain"]["frozen"] = [
            {"sites": [k], "direction": v.tolist()} for k, v in sorted(self.frozen.items())
        ]

    def bonds(self, shell=1):
        """First sites of all bonds of a shell, and of those whose two sites are there."""
        all_bonds = range(self.sites if self.periodic else self.sites - shell)
        there = [i for i in all_bonds if not {i, (i + shell) % self.sites} & self.vacant]
        return len(all_bonds), there

    def couple(self, i, j, tensor):
        self.a[i, :, j, :] += tensor
        self.a[j, :, i, :] += np.transpose(tensor)

    def exchange(self, *shells):
        """A list of J for each shell, one number for each of its bonds, those of vacant sites counted."""
        for shell, values in enumerate(shells, 1):
            _, there = self.bonds(shell)
            chosen = [float(values[i]) for i in there]
            for i, j_mev in zip(there, chosen):
                self.couple(i, (i + shell) % self.sites, -j_mev * np.eye(3))
            if there:
                self.add("exchange", J=["0 meV"] * (shell - 1) + [[f"{x} meV" for x in chosen]], bonds=there)

    def dmi(self, values, direction):
        d, (_, there) = unit(direction), self.bonds()
        cross = np.array([[0, d[2], -d[1]], [-d[2], 0, d[0]], [d[1], -d[0], 0]])
        for i in there:
            self.couple(i, (i + 1) % self.sites, values[i] * cross)
        self.add("dmi", D=[f"{float(values[i])} meV" for i in there], direction=d.tolist(), bonds=there)

    def chosen(self, values, sites):
        sites = [i for i in (range(self.sites) if sites is None else sites) if i not in self.vacant]
        return sites, np.broadcast_to(np.asarray(values, float), (len(sites),)).tolist()

    def anisotropy(self, values, axis, second=None, sites=None):
        e = unit(axis)
        sites, values = self.chosen(values, sites)
        for i, k in zip(sites, values):
            self.a[i, :, i, :] -= 2 * k * np.outer(e, e)
        more = {}
        if second is not None:
            row = np.zeros(self.sites)
            row[sites] = second
            self.quartic.append((e, row))
            more["K2"] = [f"{float(second)} meV"] * len(sites)
        self.add("anisotropy", K=[f"{k} meV" for k in values], axis=e.tolist(), sites=sites, **more)

    def cubic_anisotropy(self, values, first, second):
        frame = np.array([unit(first), unit(second), np.cross(unit(first), unit(second))])
        sites, values = self.chosen(values, None)
        row = np.zeros(self.sites)
        row[sites] = values
        self.cubic.append((frame, row))
        axes = [frame[0].tolist(), frame[1].tolist()]
        self.add("cubic_anisotropy", K=[f"{k} meV" for k in values], axes=axes, sites=sites)

    def field(self, tesla):
        there = np.array([i not in self.vacant for i in range(self.sites)])
        self.b += (self.moments * there)[:, None] * MU_B * np.asarray(tesla, float)
        self.add("zeeman", B=[f"{float(x)} T" for x in tesla])

    def dipoles(self):
        """Point dipoles in a row along x; a ring stands for a row that repeats without end."""
        along = np.diag([-2.0, 1.0, 1.0])
        n = self.sites
        there = [i for i in range(n) if i not in self.vacant]
        for i in there:
            for j in there:
                d = abs(i - j)
                if self.periodic:
                    sum_of_cubes = 2 * zeta(3, 1) if d == 0 else zeta(3, d / n) + zeta(3, 1 - d / n)
                    sum_of_cubes /= n**3
                else:
                    sum_of_cubes = 0.0 if d == 0 else d**-3.0
                strength = DIPOLE * self.moments[i] * self.moments[j] / self.spacing**3
                self.a[i, :, j, :] += strength * sum_of_cubes * along
        self.add("dipolar")

    def free(self):
        return np.array([i for i in range(self.sites) if i not in self.vacant and i not in self.frozen])

    def stiffness(self):
        """A bound of what the energy's second derivatives can be (meV)."""
        n = 3 * self.sites
        on_site = sum(12 * abs(k).max() for _, k in self.quartic) + sum(4 * abs(k).max() for _, k in self.cubic)
        return np.abs(self.a.reshape(n, n)).sum(1).max() + np.abs(self.b).max() + on_site

    def slopes(self, m):
        """Energies (states) and ∂E/∂m (states, sites, 3)."""
        n = 3 * self.sites
        linear = (m.reshape(-1, n) @ self.a.reshape(n, n)).reshape(m.shape)
        energy = 0.5 * np.sum(m * linear, axis=(1, 2)) - np.sum(m * self.b, axis=(1, 2))
        g = linear - self.b
        for e, k in self.quartic:
            c = m @ e
            energy -= (k * c**4).sum(1)
            g -= 4 * (k * c**3)[..., None] * e
        for frame, k in self.cubic:
            a = m @ frame.T
            q = a**2
            energy += (k * (q[..., 0] * q[..., 1] + q[..., 1] * q[..., 2] + q[..., 2] * q[..., 0])).sum(1)
            g += (2 * k[:, None] * a * (q.sum(-1, keepdims=True) - q)) @ frame
        return energy, g

    def curvatures(self, m):
        """What fourth powers add to ∂²E/∂m∂m, site by site (states, sites, 3, 3)."""
        h = np.zeros(m.shape + (3,))
        for e, k in self.quartic:
            h -= 12 * (k * (m @ e) ** 2)[..., None, None] * np.outer(e, e)
        for frame, k in self.cubic:
            a = m @ frame.T
            q = a**2
            own = 4 * a[..., :, None] * a[..., None, :]
            own[..., range(3), range(3)] = 2 * (q.sum(-1, keepdims=True) - q)
            h += k[:, None, None] * (frame.T @ own @ frame)
        return h


FAMILIES = {}


def family(make):
    FAMILIES[make.__name__] = make
    return make


class Numbers:
    """Random numbers of six digits, so that a config holds them as they are."""

    def __init__(self, seed):
        self.random = np.random.default_rng(seed)

    def __call__(self, least, most, count=None):
        drawn = np.round(self.random.uniform(least, most, count), 6)
        return float(drawn) if count is None else drawn

    def direction(self):
        return np.round(unit(self.random.normal(size=3)), 4)

    def happens(self, chance):
        return self.random.random() < chance

    def sites(self, least=3, most=10):
        return int(self.random.integers(least, most + 1))


@family
def ferromagnet(u):
    """Disorder in everything, axes tilted site by site, a field across."""
    n = u.sites()
    c = Chain(n, u(1, 4, n))
    c.exchange(u(1, 20, n - 1))
    c.anisotropy(u(0.2, 2.5, n), [0, 0, 1])
    for i in range(n):
        c.anisotropy(u(-0.5, 0.8), u.direction(), sites=[i])
    c.field(u(-3, 3, 3))
    return c


@family
def weak_exchange(u):
    """Each spin nearly by itself: many minima."""
    n = u.sites()
    c = Chain(n, u(1, 4, n))
    c.exchange(u(0.1, 2, n - 1))
    c.anisotropy(u(0.5, 2.5, n), u.direction())
    c.anisotropy(u(-0.8, 0.3, n), u.direction())
    c.field(u(-4, 4, 3))
    return c


@family
def antiferromagnet(u):
    n = u.sites()
    c = Chain(n, u(1, 4, n))
    c.exchange(-u(1, 10, n - 1))
    c.anisotropy(u(0.2, 1.5, n), [0, 0, 1])
    c.anisotropy(u(-0.5, 0.5, n), u.direction())
    c.field(u(-8, 8, 3))
    return c


@family
def spiral(u):
    """Second neighbours against first ones."""
    n = u.sites(5)
    c = Chain(n)
    c.exchange(np.full(n - 1, u(4, 10)), np.full(n - 2, -u(2, 6)))
    c.anisotropy(u(0.1, 0.8), u.direction())
    c.anisotropy(-u(0.1, 1.5), u.direction())
    c.field(u(-3, 3, 3))
    return c


@family
def chiral(u):
    n = u.sites()
    c = Chain(n, u(1, 4, n))
    c.exchange(u(2, 10, n - 1))
    for _ in range(1 + u.random.integers(3)):
        c.dmi(u(-4, 4, n - 1), u.direction())
    c.anisotropy(u(0.2, 1.5, n), [0, 0, 1])
    c.anisotropy(-u(0, 0.8), u.direction())
    c.field(u(-2, 2, 3))
    return c


@family
def glass(u):
    """Exchange of random sign to two shells, an axis of its own at every site."""
    n = u.sites()
    c = Chain(n, u(1, 4, n))
    c.exchange(u(-8, 8, n - 1), u(-4, 4, n - 2))
    for i in range(n):
        c.anisotropy(u(0.2, 2), u.direction(), sites=[i])
    c.field(u(-2, 2, 3))
    return c


@family
def many_axes(u):
    """Cubic axes, and an axis with a fourth power."""
    n = u.sites()
    c = Chain(n, u(1, 4, n))
    c.exchange(u(1, 8, n - 1))
    first = u.direction()
    c.cubic_anisotropy(u(-2, 2, n) if u.happens(0.5) else u(-2, 2), first, np.cross(first, u.direction()))
    c.anisotropy(u(-0.5, 0.8), u.direction(), second=u(-1, 1))
    c.field(u(-2, 2, 3))
    return c


@family
def ring(u):
    n = u.sites(4)
    c = Chain(n, u(1, 4, n), periodic=True)
    c.exchange(u(1, 10, n))
    c.anisotropy(u(0.2, 1.5, n), [0, 0, 1])
    c.dmi(u(-2, 2, n), u.direction())
    c.anisotropy(-u(0, 0.8), u.direction())
    c.field(u(-2, 2, 3))
    return c


@family
def dipoles(u):
    """Strong moments near each other, rows and rings."""
    n = u.sites()
    c = Chain(n, u(5, 20, n), periodic=u.happens(0.3), spacing=0.3)
    c.exchange(u(-5, 5, c.bonds()[0]))
    c.anisotropy(u(-3, 6, n), u.direction())
    c.field(u(-2, 2, 3))
    c.dipoles()
    return c


@family
def defects(u):
    """A vacant site, a frozen one, moments that differ by ten times."""
    n = u.sites(6)
    vacant = [int(u.random.integers(1, n - 1))] if u.happens(0.6) else []
    c = Chain(n, u(0.5, 6, n), vacant=vacant)
    site, direction = int(u.random.integers(n)), u.direction()
    if site not in vacant:
        c.freeze(site, direction)
    c.exchange(u(-2, 8, n - 1), u(-2, 2, n - 2))
    c.anisotropy(u(0.2, 1.5, n - len(vacant)), [0, 0, 1])
    c.anisotropy(u(-0.8, 0.3), u.direction())
    c.field(u(-2, 2, 3))
    return c


@family
def uniaxial(u):
    """Every rotation about z leaves the energy as it is."""
    n = u.sites()
    c = Chain(n, u(1, 4, n))
    c.axis = np.array([0.0, 0.0, 1.0])
    c.exchange(u(1, 10, n - 1))
    c.anisotropy(u(-0.2, 1.5, n), [0, 0, 1])
    c.field([0, 0, u(-2, 2)])
    if u.happens(0.5):
        c.dmi(u(-3, 3, n - 1), [0, 0, 1])
    return c


@family
def pinned_walls(u):
    n = u.sites(8)
    c = Chain(n)
    c.exchange(u(5, 12, n - 1))
    c.anisotropy(u(0.3, 1, n), [0, 0, 1])
    c.anisotropy(-u(0.05, 0.5), [1, 0, 0])
    c.field([0, 0, u(-0.5, 0.5)])
    return c


def chain(number):
    """The chain of a number, the families by turns."""
    name = list(FAMILIES)[number % len(FAMILIES)]
    made = FAMILIES[name](Numbers([2101, number]))
    made.config["name"] = f"{name}_{number}"
    return name, made
