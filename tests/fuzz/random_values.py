"""Random sizes, vectors and colors of the scenes of random_scenes.py."""
import math
import random
import struct

LARGEST = 1e12  # No coordinate is larger than a few times this.


def short(number):
    """The number with 12 digits, which keeps files readable."""
    return float(f"{number:.12g}")


def single(number):
    """The number in single precision."""
    return struct.unpack("f", struct.pack("f", number))[0]


def plus(a, b, factor=1.0):
    return [short(p + factor * q) for p, q in zip(a, b)]


def length(vector):
    return math.hypot(*vector)


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class RandomValues:
    """Draws values that suit one scene."""

    def __init__(self, seed):
        """Chooses the range of sizes of objects, the size that most of them have, and the center of the scene."""
        self.random = random.Random(seed)
        self.pick, self.uniform = self.random.choice, self.random.uniform
        kind = self.random.choices(["ordinary", "wide", "extreme"], [8, 3, 1])[0]
        extreme = self.pick([(1e-9, 1e-6), (1e6, 1e9), (1e-9, 1e9), (1e-9, 1e9), (1e9, LARGEST / 10)])
        self.smallest, self.largest = {"ordinary": (0.01, 100), "wide": (1e-4, 1e4), "extreme": extreme}[kind]
        self.unit = self.log_uniform(self.smallest, self.largest)
        self.scales = (1e-3, 1e3) if kind == "extreme" else (0.2, 5)  # of transforms
        far = min(self.unit * self.log_uniform(10, 1e6), LARGEST)
        self.center = self.direction(far) if self.chance(0.2) else [0, 0, 0]
        self.reach = 10 * self.largest  # of the objects from the center

    def chance(self, probability):
        return self.random.random() < probability

    def some(self, values, probability=0.5):
        """Some of these optional keys and values."""
        return {key: value for key, value in values.items() if self.chance(probability)}

    def log_uniform(self, low, high):
        return short(math.exp(self.uniform(math.log(low), math.log(high))))

    def size(self):
        """The size of an object: mostly about that of the others, otherwise any of the scene's range."""
        if self.chance(0.3):
            return self.log_uniform(self.smallest, self.largest)
        return min(max(self.unit * self.log_uniform(0.1, 2), self.smallest), self.largest)

    def direction(self, size=1.0):
        """A vector of this length. A third of the vectors lie along an axis."""
        vector = [self.random.gauss(0, 1) for _ in range(3)]
        if self.chance(0.33):
            vector = self.pick([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
        return [short(size * x / length(vector)) for x in vector]

    def any_length(self):
        """A vector of which only the direction matters."""
        return self.direction(self.pick([1, self.uniform(0.1, 10), self.log_uniform(1e-9, 1e9)]))

    def place(self):
        return plus(self.center, [self.uniform(-2, 2) * self.unit for _ in range(3)])

    def fraction(self):
        return self.pick([0, 1, short(self.uniform(0, 1)), short(self.uniform(0, 1)), self.log_uniform(1e-9, 1)])

    def color(self):
        """A color in [0, 1], as a number or three."""
        return self.fraction() if self.chance(0.4) else [self.fraction() for _ in range(3)]

    def power(self, usual):
        """A color in [0, 1e12] for light: none, about the usual amount, or any amount."""
        amount = self.random.choices([0, min(usual, 1e12), self.log_uniform(1e-12, 1e12), 1e12], [2, 12, 2, 1])[0]
        return amount if self.chance(0.4) else [amount * self.fraction() for _ in range(3)]
