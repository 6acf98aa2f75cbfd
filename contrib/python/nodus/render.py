"""Pictures of quadrilateral surfaces without a display: orthographic projection, z-buffer, NumPy only.

Every quadrilateral, of first or second order, is sampled more densely than the pixels, and the nearest sample of each
pixel wins. That is exact about what hides what, which sorting polygons is not.
"""

import numpy as np

SUPERSAMPLING = 2
EDGE_COLOUR = np.array([0.10, 0.10, 0.12])


def boundary_faces(mesh, keep=None):
    """(n, k, k) node numbers of the faces that belong to one cell only; nodes of different cells are matched by their
    reference position, since ranks have nodes of their own."""
    cells = mesh.cells if keep is None else mesh.cells[keep]
    position = mesh.reference
    tolerance = 1e-6 * np.ptp(position, axis=0).max()
    key = np.zeros((len(position), 4), int)
    key[:, 3] = mesh.fields["body"].round()
    for axis in range(3):
        # clusters of equal coordinates: rounding to a grid would tear apart values next to a grid line
        order = np.argsort(position[:, axis])
        key[order[1:], axis] = np.cumsum(np.diff(position[order, axis]) > tolerance)
    node = np.unique(key, axis=0, return_inverse=True)[1].ravel()

    faces = [cells[:, index] for index in (0, -1)]
    faces += [cells[:, :, index] for index in (0, -1)]
    faces += [cells[:, :, :, index] for index in (0, -1)]
    faces = np.concatenate(faces)
    corners = np.sort(node[faces[:, ::faces.shape[1] - 1, ::faces.shape[2] - 1].reshape(-1, 4)], axis=1)
    first, count = np.unique(corners, axis=0, return_index=True, return_counts=True)[1:]
    return faces[first[count == 1]]


def view_axes(azimuth, elevation):
    """Right, up and towards-the-viewer unit vectors for a viewer in this direction; angles in degrees."""
    a, e = np.radians([azimuth, elevation])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.array([right, np.cross(towards, right), towards])


def axes_facing(normal, either_side):
    """The same for a viewer who looks at a surface from the side its normal points to, with z upwards, or x to the right
    when that is impossible. From either side, when both show the same, the picture is not mirrored."""
    towards = normal / np.linalg.norm(normal)
    nearest = np.eye(3)[np.argmax(np.abs(towards))] * np.sign(towards[np.argmax(np.abs(towards))])
    if towards @ nearest > 0.97:  # coordinates can then be read off the picture
        towards = nearest
    flat = abs(towards[2]) > 0.8
    if either_side and (towards[2] < 0 if flat else towards[1] - towards[0] > 0):
        towards = -towards
    right = np.array([1.0, 0, 0]) if flat else np.cross([0, 0, 1.0], towards)
    right -= towards * (towards @ right)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])


def _shape(points_per_direction, s):
    """Lagrange polynomials of degree 1 or 2 on [0, 1] and their derivatives: (samples, nodes)."""
    one = np.ones_like(s)
    if points_per_direction == 2:
        return np.stack([1 - s, s], 1), np.stack([-one, one], 1)
    return (
        np.stack([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)], 1),
        np.stack([4 * s - 3, 4 - 8 * s, 4 * s - 1], 1),
    )


def render(points, faces, values, axes, window, pixels, colours, shading=0.35, edges=0.45):
    """RGBA image of the faces in the window (left, right, bottom, top) of the plane of axes[0], axes[1].

    values are nodal, colours maps an array of values to RGB; edges is the strength of the mesh lines (0: none).
    """
    width, height = (SUPERSAMPLING * n for n in pixels)
    left, right, bottom, top = window
    scale = width / (right - left)
    projected = points @ axes.T
    depth = np.full(width * height, -np.inf)
    image = np.zeros((width * height, 4))

    corners = projected[faces]
    low, high = corners[..., :2].min((1, 2)), corners[..., :2].max((1, 2))
    inside = (low[:, 0] < right) & (high[:, 0] > left) & (low[:, 1] < top) & (high[:, 1] > bottom)
    faces = faces[inside]
    corners = projected[faces]

    def extent(along):
        return scale * np.linalg.norm(np.diff(corners[..., :2], axis=along), axis=-1).sum(along).max(1)

    # samples per direction in powers of two, so that few groups share their shape functions
    samples = [2 ** np.ceil(np.log2(np.clip(1.5 * extent(along), 2, 4096))).astype(int) for along in (2, 1)]
    k = faces.shape[1]
    for m, n in np.unique(np.stack(samples, 1), axis=0):
        group = np.flatnonzero((samples[0] == m) & (samples[1] == n))
        (phi, dphi), (chi, dchi) = (_shape(k, (np.arange(count) + 0.5) / count) for count in (m, n))
        to_border = [np.minimum(np.arange(count) + 0.5, count - np.arange(count) - 0.5) / count for count in (m, n)]
        step = max(1, 2**21 // (m * n))
        for start in range(0, len(group), step):
            some = group[start : start + step]
            x = corners[some]
            def interpolate(a, b, f):
                return np.einsum("nj,fji...,mi->fnm...", b, f, a, optimize=True)
            position = interpolate(phi, chi, x)
            normal = np.cross(interpolate(dphi, chi, x), interpolate(phi, dchi, x))
            facing = np.abs(normal[..., 2]) / np.maximum(np.linalg.norm(normal, axis=-1), 1e-300)
            value = interpolate(phi, chi, values[faces[some]])
            # distance to the nearest edge of the face in pixels
            length = [scale * np.linalg.norm(interpolate(*ab, x)[..., :2], axis=-1) for ab in
                      ((dphi, chi), (phi, dchi))]
            border = np.minimum(to_border[0][None, None, :] * length[0], to_border[1][None, :, None] * length[1])
            size = np.minimum(length[0], length[1])
            line = np.clip(1.4 - border, 0, 1) * np.clip((size - 8) / 40, 0, 1) * edges

            column = ((position[..., 0] - left) * scale).astype(int)
            row = ((top - position[..., 1]) * scale).astype(int)
            seen = (column >= 0) & (column < width) & (row >= 0) & (row < height)
            pixel, z = (row * width + column)[seen], position[..., 2][seen]
            order = np.argsort(z)
            order = order[z[order] > depth[pixel[order]]]
            pixel = pixel[order]
            depth[pixel] = z[order]  # ascending, so the nearest is assigned last
            rgb = colours(value[seen][order]) * (1 - shading + shading * facing[seen][order])[:, None]
            line = line[seen][order][:, None]
            image[pixel, :3] = rgb * (1 - line) + EDGE_COLOUR * line
            image[pixel, 3] = 1
    image = image.reshape(height, width, 4)
    image[..., :3] *= image[..., 3:]
    image = image.reshape(height // SUPERSAMPLING, SUPERSAMPLING, width // SUPERSAMPLING, SUPERSAMPLING, 4).mean((1, 3))
    image[..., :3] /= np.maximum(image[..., 3:], 1e-12)
    return np.clip(image, 0, 1)
