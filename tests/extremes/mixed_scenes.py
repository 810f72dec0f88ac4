"""Scene K of seed S for the relations: all elements, both quadratures, curved sides, temperatures, joints and histories in one deck.

mixed_scenes.py K S     prints the deck

Blocks, laws and loads are those of error_bounds.py. A third of the scenes is bent into arcs, a fifth turned round an axis; of the
others some have a tie in the place of a pair, springs, an equation, few digits. One to three steps of one to four increments.
"""

import sys

import numpy as np

sys.dont_write_bytecode = True  # the sources stay as they are
import error_bounds
from deck_relations import Deck, of_increments, scaled_step


def bend(mesh, radius):
    x, r = mesh.nodes[:, 0]/radius, radius + mesh.nodes[:, 1]
    mesh.nodes = np.stack([r*np.sin(x), r*np.cos(x) - radius], axis=1)


def shape(scene, meshes, rng):
    """The state of the elements; blocks get their places."""
    places = np.vstack([mesh.nodes for mesh in meshes])
    if rng.random() < 0.35:
        radius = rng.choice((-1, 1))*rng.uniform(1.5, 5)*places[:, 1].max()
        for mesh in meshes:
            bend(mesh, radius)
    if scene.angle == 0 and rng.random() < 0.2:
        away = rng.choice((0.0, rng.uniform(0.1, 2))) - min(mesh.nodes[:, 0].min() for mesh in meshes)
        for mesh in meshes:
            mesh.nodes = mesh.nodes + [away, 0.0]
        return 'CAX'
    return 'CPS' if scene.is_plane_stress else 'CPE'


def add_joints(deck, scene, meshes, rng):
    """A tie, springs, an equation, before the step."""
    at = next(i for i, card in enumerate(deck.cards) if card[0] == 'STEP')
    if rng.random() < 0.2:
        place = next(i for i, card in enumerate(deck.cards) if card[0] == 'CONTACT PAIR')
        pair = deck.cards[place][2]
        deck.cards[place] = ('TIE', {'NAME': 'GLUE', 'ADJUST': 'NO'}, pair)
        deck.cards = [card for card in deck.cards if card[0] != 'CLEARANCE' or card[1]['SLAVE'] != pair[0][0]]
        at = next(i for i, card in enumerate(deck.cards) if card[0] == 'STEP')
    top = [meshes[-1].first_node + k for k in meshes[-1].on_side['TOP']]
    if rng.random() < 0.2:
        element, stiffness = meshes[-1].first_element + len(meshes[-1].elements), 0.1*scene.young.min()
        deck.cards[at:at] = [('ELEMENT', {'TYPE': 'SPRING1', 'ELSET': 'BED'}, [[str(element + i), str(k)] for i, k in enumerate(top)]),
                             ('SPRING', {'ELSET': 'BED'}, [[str(rng.integers(1, 3))], [repr(float(stiffness))]])]
    if scene.hold[-1] != 'TOP' and rng.random() < 0.2:
        deck.cards[at:at] = [('EQUATION', {}, [['2'], [str(top[1]), '2', '1.', str(top[-2]), '2', '-1.']])]


def add_steps(deck, rng):
    """Loads that grow, turn back and come again."""
    for _, options, _ in deck.each('FRICTION'):
        if rng.random() < 0.3:
            options['SLIP'] = str(rng.choice(('TOTAL', 'INCREMENTAL')))
    head, steps = deck.steps()
    prints = [('NODE PRINT', {}, [['RF']]), ('EL PRINT', {}, [['S']])]
    steps[0][-1:-1] = prints
    factors = [rng.uniform(0.05, 1.2) for _ in range(rng.choice((0, 0, 1, 2)))] + [1.0]
    deck.cards = head + [card for factor in factors
                         for card in of_increments(scaled_step(steps[0], float(factor)), int(rng.choice((1, 1, 2, 4))))]


def make(number, seed, digits=None):
    """What the scene is, and its deck; of a scene of few digits with all of them if `digits` is 17."""
    scene, rng = error_bounds.Scene(number, seed), np.random.default_rng([seed, number, 1])
    meshes = scene.meshes(scene.kinds, 1)
    state = shape(scene, meshes, rng)
    few = int(rng.choice((17, 17, 17, 12, 8, 6)))
    for mesh in meshes:
        if (digits or few) < 17:
            mesh.nodes = np.round(mesh.nodes, few - 1)
    deck = Deck(scene.deck(meshes, scene.kinds, meshes, state))
    add_joints(deck, scene, meshes, rng)
    add_steps(deck, rng)
    return f'{state} {"/".join(dict.fromkeys(scene.kinds))} {scene.quadrature or "any"}', deck.text()


if __name__ == '__main__':
    sys.stdout.write(make(int(sys.argv[1]), int(sys.argv[2]))[1])
