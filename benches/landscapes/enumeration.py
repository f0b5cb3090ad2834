"""Minima and saddles of a small chain from very many starts, and the ways between its lowest minima.

Saddles by following eigenvectors (up along the lowest mode, down along all others), descents by implicit Euler steps with true
Hessians, many states at once. All are found to a torque of 1e-11 of the stiffness, or do not count. What is meant by "all" is only
that further starts found nothing more.
"""

import networkx
import numpy as np

TORQUE = 1e-11
ZERO = 1e-9
SAME_ENERGY = 1e-7
SAME_SPINS = 1e-3


class Surface:
    """The energy of a chain over the spins that are free to turn."""

    def __init__(self, chain):
        self.chain, self.free, self.scale = chain, chain.free(), chain.stiffness()
        self.hessian_mev = np.ascontiguousarray(chain.a[self.free][:, :, self.free])

    def whole(self, free_spins):
        """States of the free spins with those that are not."""
        m = np.zeros((len(free_spins), self.chain.sites, 3))
        m[:, :, 2] = 1.0
        for site, direction in self.chain.frozen.items():
            m[:, site] = direction
        m[:, self.free] = free_spins
        return m

    def look(self, m):
        """Energies, Riemannian gradients (states, 2n), Hessians (states, 2n, 2n) and the bases that they are in (states, n, 2, 3)."""
        energy, g = self.chain.slopes(m)
        own, s, g = self.chain.curvatures(m)[:, self.free], m[:, self.free], g[:, self.free]
        basis = tangents(s)
        count, n = s.shape[:2]
        gradient = np.einsum("bnai,bni->bna", basis, g).reshape(count, 2 * n)
        right = np.einsum("nimj,bmcj->bnimc", self.hessian_mev, basis, optimize=True)
        h = np.einsum("bnai,bnimc->bnamc", basis, right, optimize=True)
        local = np.einsum("bnai,bnij,bncj->bnac", basis, own, basis, optimize=True)
        local -= np.sum(s * g, axis=2)[..., None, None] * np.eye(2)
        every = np.arange(n)
        h[:, every, :, every, :] += np.moveaxis(local, 1, 0)
        return energy, gradient, h.reshape(count, 2 * n, 2 * n), basis

    def turned(self, m, step, basis):
        """States moved along steps in their bases."""
        v = np.einsum("bna,bnai->bni", step.reshape(basis.shape[:3]), basis)
        angle = np.linalg.norm(v, axis=2, keepdims=True)
        s = np.cos(angle) * m[:, self.free] + np.sinc(angle / np.pi) * v
        out = m.copy()
        out[:, self.free] = s / np.linalg.norm(s, axis=2, keepdims=True)
        return out

    def index(self, m):
        """Largest torque over the stiffness, and how many modes descend and are flat."""
        _, gradient, h, _ = self.look(m)
        w = np.linalg.eigvalsh(h)
        return abs(gradient).max(1) / self.scale, (w < -ZERO * self.scale).sum(1), (abs(w) <= ZERO * self.scale).sum(1)

    def saddles(self, m, steps=150):
        """The saddles of index one that climbs from states come to, as far as they do."""
        found = []
        for _ in range(steps):
            energy, gradient, h, basis = self.look(m)
            w, modes = np.linalg.eigh(h)
            still = abs(gradient).max(1) > TORQUE * self.scale
            at_rest = ~still & ((w < -ZERO * self.scale).sum(1) == 1)
            found += list(zip(m[at_rest], energy[at_rest]))
            if not still.any():
                break
            m, w, modes, basis = m[still], w[still], modes[still], basis[still]
            along = np.einsum("bki,bk->bi", modes, gradient[still])
            flat = abs(w) < ZERO * self.scale
            step = np.where(flat, 0.0, np.clip(along / np.where(flat, 1.0, abs(w)), -0.5, 0.5))
            step[:, 1:] *= -1
            m = self.turned(m, shortened(np.einsum("bik,bk->bi", modes, step), 0.25), basis)
        return found

    def minima(self, m, steps=1000, farthest=0.15):
        """Where descents from states end: their spins, energies, and whether each is a minimum."""
        duration = np.full(len(m), 0.3 / self.scale)
        energy, gradient, h, basis = self.look(m)
        running = np.ones(len(m), bool)
        for _ in range(steps):
            running &= (abs(gradient).max(1) > TORQUE * self.scale) & (duration > 1e-8 / self.scale)
            k = np.flatnonzero(running)
            if not len(k):
                break
            w, modes = np.linalg.eigh(h[k])
            damped = np.maximum(w + 1 / duration[k, None], 0.3 / duration[k, None])
            step = -np.einsum("bij,bj->bi", modes, np.einsum("bji,bj->bi", modes, gradient[k]) / damped)
            size = largest(step)
            to = self.turned(m[k], shortened(step, farthest), basis[k])
            new = self.look(to)
            lower = new[0] <= energy[k] + 1e-13 * self.scale * h.shape[1]
            duration[k] *= np.where(lower, np.where(size < 0.5 * farthest, 2.0, 1.0), 0.25)
            k = k[lower]
            m[k] = to[lower]
            energy[k], gradient[k], h[k], basis[k] = (part[lower] for part in new)
        torque, negative, _ = self.index(m)
        return m, energy, (torque < 1e2 * TORQUE) & (negative == 0)

    def beside(self, m, turn=0.03):
        """States on the two sides of saddles."""
        _, _, h, basis = self.look(m)
        fall = np.linalg.eigh(h)[1][:, :, 0]
        fall *= turn / largest(fall)[:, None]
        return [self.turned(m, sense * fall, basis) for sense in (1, -1)]


def tangents(s):
    """Two unit vectors across each spin."""
    least = np.argmin(abs(s), axis=2)
    first = np.eye(3)[least] - np.take_along_axis(s, least[..., None], 2) * s
    first /= np.linalg.norm(first, axis=2, keepdims=True)
    return np.stack([first, np.cross(s, first)], axis=2)


def largest(step):
    return np.sqrt((step.reshape(len(step), -1, 2) ** 2).sum(2).max(1))


def shortened(step, most):
    return step * np.minimum(1.0, most / np.maximum(largest(step), 1e-300))[:, None]


class Known:
    """States, each once; where a rotation about an axis makes one of another the two are one."""

    def __init__(self, surface):
        self.surface, self.spins, self.energies = surface, [], []

    def standard(self, m):
        """Turned about the symmetry axis so that the first spin that lies off it is in the x, z plane."""
        s = m[self.surface.free]
        if self.surface.chain.axis is None:
            return s
        off = s[:, 0] ** 2 + s[:, 1] ** 2
        if off.max() < 1e-8:
            return s
        x, y, _ = s[np.argmax(off > 0.25 * off.max())] / np.sqrt(off[np.argmax(off > 0.25 * off.max())])
        return s @ np.array([[x, -y, 0], [y, x, 0], [0, 0, 1]])

    def find(self, m, energy):
        s = self.standard(m)
        for k, (spins, other) in enumerate(zip(self.spins, self.energies)):
            if abs(other - energy) < SAME_ENERGY * self.surface.scale and abs(spins - s).max() < SAME_SPINS:
                return k
        return None

    def add(self, m, energy):
        """Its number, and whether it is new."""
        k = self.find(m, energy)
        if k is not None:
            return k, False
        self.spins.append(self.standard(m))
        self.energies.append(float(energy))
        return len(self.spins) - 1, True

    def states(self, which):
        return self.surface.whole(np.array([self.spins[k] for k in which]))


class Landscape:
    """Minima and the saddles between them, from whoever found them."""

    def __init__(self, chain):
        self.surface = Surface(chain)
        self.minima, self.saddles, self.ends = Known(self.surface), Known(self.surface), []

    def add_minima(self, m):
        """Relaxes states; their minima's numbers, None where a descent ends at none."""
        spins, energies, good = self.surface.minima(m.copy())
        return [self.minima.add(s, e)[0] if ok else None for s, e, ok in zip(spins, energies, good)]

    def add_saddles(self, found):
        """Saddles with their energies; how many were new."""
        new = [(m, energy) for m, energy in found if self.saddles.add(m, energy)[1]]
        if new:
            sides = self.surface.beside(np.array([m for m, _ in new]))
            self.ends += list(zip(*(self.add_minima(side) for side in sides)))
        return len(new)

    def lowest(self, count=10):
        return sorted(range(len(self.minima.energies)), key=self.minima.energies.__getitem__)[:count]

    def passes(self):
        """(energy, minimum, minimum, saddle), the lowest first, without those that lead back to where they come from."""
        joined = ((e, *ends, k) for k, (e, ends) in enumerate(zip(self.saddles.energies, self.ends)))
        return sorted(p for p in joined if None not in p and p[1] != p[2])

    def tops(self):
        """For each pair of the lowest minima how high its lowest way leads; none where no way is known."""
        parts, tops = networkx.utils.UnionFind(range(len(self.minima.energies))), {}
        low = self.lowest()
        pairs = [(a, b) for k, a in enumerate(low) for b in low[:k]]
        for energy, a, b, _ in self.passes():
            if parts[a] != parts[b]:
                parts.union(a, b)
                tops.update({pair: energy for pair in pairs if pair not in tops and parts[pair[0]] == parts[pair[1]]})
        return tops, len(pairs)

    def on_routes(self):
        """Minima and saddles on any way between two of the lowest minima that is as low as can be: on any that meets no minimum
        twice, and no pass above the highest one of the lowest way."""
        passes, (tops, _) = self.passes(), self.tops()
        minima, saddles = set(self.lowest()), set()
        for (a, b), top in tops.items():
            graph = networkx.Graph()
            below = [p for p in passes if p[0] <= top + SAME_ENERGY * self.surface.scale]
            graph.add_edges_from((p[1], p[2]) for p in below)
            graph.add_edge(a, b)
            # an edge lies on such a way if it lies on a circle with an edge from a to b
            for edges in networkx.biconnected_component_edges(graph):
                edges = {frozenset(edge) for edge in edges}
                if frozenset((a, b)) in edges:
                    saddles |= {p[3] for p in below if frozenset(p[1:3]) in edges}
                    minima |= {k for p in below if frozenset(p[1:3]) in edges for k in p[1:3]}
        return minima, saddles


def random_states(surface, random, count):
    """States of random spins, uniform ones, and two domains with a little noise, parallel or alternating."""
    n = surface.chain.sites
    m = random.normal(size=(count, n, 3))
    for k in range(count):
        kind, direction = k % 3, random.normal(size=3)
        if kind == 1:
            m[k] = direction
        elif kind == 2:
            sign = np.where(np.arange(n) < random.integers(n + 1), 1.0, -1.0)
            sign *= (-1.0) ** np.arange(n) if random.random() < 0.5 else 1.0
            m[k] = sign[:, None] * direction / np.linalg.norm(direction) + 0.05 * m[k]
    return surface.whole((m / np.linalg.norm(m, axis=2, keepdims=True))[:, surface.free])


def starts(landscape, random, count, ceiling_mev):
    """Where climbs begin: random states, minima with some spins turned, and mixtures of two minima."""
    surface, known = landscape.surface, landscape.minima
    n = surface.chain.sites
    low = [k for k in range(len(known.energies)) if known.energies[k] < ceiling_mev] or landscape.lowest()
    out = random_states(surface, random, count)
    x = np.arange(n)
    a, b = (known.states(random.choice(low, size=count)) for _ in range(2))
    for k in range(count):
        kind, noise = random.random(), random.normal(size=(n, 3))
        if kind < 0.15:
            continue
        if kind < 0.5:
            near = np.exp(-(((x - random.integers(n)) / random.uniform(0.5, n)) ** 2))
            mixed = a[k] + random.uniform(0.3, 2) * near[:, None] * noise
        else:
            if surface.chain.axis is not None:
                angle = random.uniform(0, 2 * np.pi)
                cos, sin = np.cos(angle), np.sin(angle)
                b[k] = b[k] @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
            centre, width = random.uniform(-1, n), random.uniform(0.2, 2)
            part = [
                np.full(n, random.uniform(0.1, 0.9)),
                1 / (1 + np.exp(np.clip((x - centre) / width * random.choice([-1, 1]), -50, 50))),
                1 / (1 + np.exp(np.clip((abs(x - centre) - random.uniform(0.3, n / 2)) / width, -50, 50))),
            ][random.integers(3)][:, None]
            mixed = (1 - part) * a[k] + part * b[k] + random.uniform(0.02, 0.3) * noise
        out[k, surface.free] = (mixed / np.linalg.norm(mixed, axis=1, keepdims=True))[surface.free]
    return out


def enumerated(chain, seed, batch=400, quiet=4, most=60):
    """All minima and saddles up to the highest pass that the lowest ways between the ten lowest minima lead over, as far as `quiet`
    batches of climbs in a row found no more; and how many climbs that took."""
    random, landscape = np.random.default_rng(seed), Landscape(chain)
    landscape.add_minima(random_states(landscape.surface, random, 240))
    silent = number = 0
    while silent < quiet and number < most:
        tops, pairs = landscape.tops()
        ceiling = max(tops.values()) if len(tops) == pairs and tops else np.inf
        low = landscape.lowest()
        found = landscape.surface.saddles(starts(landscape, random, batch, ceiling))
        news = landscape.add_saddles([(m, e) for m, e in found if e <= ceiling + SAME_ENERGY * landscape.surface.scale])
        silent = 0 if news or low != landscape.lowest() else silent + 1
        number += 1
    return landscape, number * batch, silent >= quiet
