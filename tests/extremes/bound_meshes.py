"""Blocks of any element, and the same blocks divided: meshes for error_bounds.py. No code of the program."""

import numpy as np

from shape_functions import NINE, shapes

TRIANGLE_SIX = np.array([[0, 0], [1, 0], [0, 1], [.5, 0], [.5, .5], [0, .5]])
SIDES = ('BOTTOM', 'RIGHT', 'TOP', 'LEFT')
#: of 3 and 6 nodes: (r, s, weight), exact to degree 4
A, B, WA, WB = 0.445948490915965, 0.091576213509771, 0.111690794839005, 0.054975871827661
SIX_POINTS = [(A, A, WA), (1 - 2*A, A, WA), (A, 1 - 2*A, WA), (B, B, WB), (1 - 2*B, B, WB), (B, 1 - 2*B, WB)]
ROOT = np.sqrt(0.6)
NINE_POINTS = [(x, y, v*w) for x, v in zip((-ROOT, 0, ROOT), (5/9, 8/9, 5/9))
               for y, w in zip((-ROOT, 0, ROOT), (5/9, 8/9, 5/9))]


def natural_nodes(n):
    return TRIANGLE_SIX[:n] if n in (3, 6) else NINE[:n]


class Block:
    """A quadrilateral cut into cells, coarse: each has its corners, and the sides of the block on its faces."""

    def __init__(self, corners, xs, ys, is_triangle, roughness=0.0, rng=None):
        self.cells, self.faces = [], []
        place = np.array([[self.map(corners, x, y) for x in xs] for y in ys])
        if roughness > 0:
            place[1:-1, 1:-1] += roughness*(rng.random((len(ys) - 2, len(xs) - 2, 2)) - 0.5)
        for j in range(len(ys) - 1):
            for i in range(len(xs) - 1):
                v = [place[j, i], place[j, i + 1], place[j + 1, i + 1], place[j + 1, i]]
                on = [j == 0, i == len(xs) - 2, j == len(ys) - 2, i == 0]
                on = [side if is_on else None for side, is_on in zip(SIDES, on)]
                if is_triangle:
                    self.add([v[0], v[1], v[2]], [on[0], on[1], None])
                    self.add([v[0], v[2], v[3]], [None, on[2], on[3]])
                else:
                    self.add(v, on)

    def add(self, corners, faces):
        self.cells.append(np.array(corners))
        self.faces.append(faces)

    @staticmethod
    def map(corners, x, y):
        c = np.array(corners, float)
        return (1 - x)*(1 - y)*c[0] + x*(1 - y)*c[1] + x*y*c[2] + (1 - x)*y*c[3]


def children(n_corners, m):
    """Pieces of a cell: corners in its natural coordinates, and its face on each face of the piece."""
    found = []
    if n_corners == 4:
        at = np.linspace(-1, 1, m + 1)
        for j in range(m):
            for i in range(m):
                corners = [(at[i], at[j]), (at[i + 1], at[j]), (at[i + 1], at[j + 1]), (at[i], at[j + 1])]
                found.append((corners, [0 if j == 0 else None, 1 if i == m - 1 else None, 2 if j == m - 1 else None,
                                        3 if i == 0 else None]))
        return found
    at = np.linspace(0, 1, m + 1)
    for j in range(m):
        for i in range(m - j):
            found.append(([(at[i], at[j]), (at[i + 1], at[j]), (at[i], at[j + 1])],
                          [0 if j == 0 else None, 1 if i + j == m - 1 else None, 2 if i == 0 else None]))
            if i + j < m - 1:
                found.append(([(at[i + 1], at[j]), (at[i + 1], at[j + 1]), (at[i], at[j + 1])], [None]*3))
    return found


class Mesh:
    """Elements of n nodes on the pieces of a block's cells: `elements`, cell by cell, and piece by piece within."""

    def __init__(self, block, n, m, first_node, first_element):
        self.n, self.m = n, m
        self.n_corners = 3 if n in (3, 6) else 4
        self.pieces = children(self.n_corners, m)
        self.first_node, self.first_element = first_node, first_element
        self.sides = {side: [] for side in SIDES}       # (element, face), from 1
        self.on_side = {side: {} for side in SIDES}     # nodes, in the order of a dict
        self.nodes, self.elements, number = [], [], {}
        self.places = np.array([self.nodes_of_piece(corners) for corners, _ in self.pieces])
        size = np.ptp(np.concatenate(block.cells), axis=0).max()
        for c, corners in enumerate(block.cells):
            for p, (_, faces) in enumerate(self.pieces):
                x = np.array([shapes(self.n_corners, a, b)[0] @ corners for a, b in self.places[p]])
                of_element = []
                for point in x:
                    key = tuple(np.round(point/size*1e7).astype(int))
                    if key not in number:
                        number[key] = len(self.nodes)
                        self.nodes.append(point)
                    of_element.append(number[key])
                self.elements.append(of_element)
                for face, of_cell in enumerate(faces):
                    side = None if of_cell is None else block.faces[c][of_cell]
                    if side:
                        self.sides[side].append((first_element + len(self.elements) - 1, face + 1))
                        for k in face_nodes(n, face):
                            self.on_side[side][of_element[k]] = True
        self.nodes, self.elements = np.array(self.nodes), np.array(self.elements)
        self.n_cells = len(block.cells)

    def nodes_of_piece(self, corners):
        corners = np.array(corners)
        return [shapes(self.n_corners, a, b)[0] @ corners for a, b in natural_nodes(self.n)]

    def cell_values(self, values, coarse):
        """Values of nodes as a coarse mesh has them, by its shape functions, at the nodes of this one."""
        found = np.zeros((len(self.nodes),) + values.shape[1:])
        for c in range(self.n_cells):
            for p in range(len(self.pieces)):
                for k, (a, b) in enumerate(self.places[p]):
                    found[self.elements[c*len(self.pieces) + p][k]] = shapes(coarse.n, a, b)[0] @ values[coarse.elements[c]]
        return found


def face_nodes(n, face):
    corners = 3 if n in (3, 6) else 4
    ends = [face, (face + 1) % corners]
    return ends + [corners + face] if n > corners else ends


def strains(n, x, u, a, b):
    """e11, e22, g12 (elements, 3) and the Jacobian's determinant at natural coordinates of all elements."""
    slope = shapes(n, a, b)[1]
    j = np.einsum('eai,ak->eik', x, slope)
    det = j[:, 0, 0]*j[:, 1, 1] - j[:, 0, 1]*j[:, 1, 0]
    g = np.einsum('ak,eki->eai', slope, np.linalg.inv(j))
    h = np.einsum('eai,eaj->eij', u, g)
    return np.stack([h[:, 0, 0], h[:, 1, 1], h[:, 0, 1] + h[:, 1, 0]], axis=1), det


def distance(coarse, u, fine, u_fine, d_matrix):
    """Squares of the energy norms of the difference of two displacements, and of the fine ones."""
    square = whole = 0.0
    n_pieces = len(fine.pieces)
    points = SIX_POINTS if fine.n_corners == 3 else NINE_POINTS
    x, x_fine = coarse.nodes[coarse.elements], fine.nodes[fine.elements]
    for p, (corners, _) in enumerate(fine.pieces):
        mine = slice(p, None, n_pieces)
        for a, b, weight in points:
            e_fine, det = strains(fine.n, x_fine[mine], u_fine[fine.elements[mine]], a, b)
            at = shapes(fine.n_corners, a, b)[0] @ np.array(corners)
            e, _ = strains(coarse.n, x, u[coarse.elements], at[0], at[1])
            off = e_fine - e
            square += weight*np.sum(det*np.einsum('ei,ij,ej->e', off, d_matrix, off))
            whole += weight*np.sum(det*np.einsum('ei,ij,ej->e', e_fine, d_matrix, e_fine))
    return square, whole


def elasticity(young, poisson, is_plane_stress, thickness):
    if is_plane_stress:
        c = young/(1 - poisson**2)
        return thickness*c*np.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, (1 - poisson)/2]])
    c = young/(1 + poisson)/(1 - 2*poisson)
    return thickness*c*np.array([[1 - poisson, poisson, 0], [poisson, 1 - poisson, 0], [0, 0, (1 - 2*poisson)/2]])
