"""Curves of contact mechanics that profiles are compared with (Johnson, Contact Mechanics, 1985, ch. 4, 7)."""

import numpy as np


def hertz_sphere(force, radius, modulus):
    """Contact radius and largest pressure of spheres; modulus is E*, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2."""
    a = (3 * force * radius / (4 * modulus)) ** (1 / 3)
    return a, 3 * force / (2 * np.pi * a**2)


def hertz_cylinder(force, radius, modulus):
    """Half width and largest pressure of cylinders; force is per length."""
    a = np.sqrt(4 * force * radius / (np.pi * modulus))
    return a, 2 * force / (np.pi * a)


def elliptic(r, a, p0):
    """Pressure over the distance from the centre."""
    return p0 * np.sqrt(np.maximum(0, 1 - (r / a) ** 2))


def partial_slip(r, a, p0, friction, stick):
    """Shear traction of Cattaneo and Mindlin: the limit outside of the stick radius, less a second ellipse inside."""
    return friction * (elliptic(r, a, p0) - stick / a * elliptic(r, stick, p0))


def stick_radius(a, ratio, dimension):
    """Radius (dimension 3, spheres) or half width (2, cylinders); ratio is the tangential force over friction times
    normal force."""
    return a * max(0.0, 1 - ratio) ** (1 / dimension)
