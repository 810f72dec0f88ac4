"""The catalogue of growing decks that growth.py measures: a kind is a function of n that makes files, the first one the deck.

Each is a sound scene of two small blocks in contact in which one thing grows, or, `bad_...`, a deck with n errors of a kind."""

KINDS = {}


def kind(most=1000000, options=(), mode='both'):
    """most: the largest n that a file of some 100 MB, or a small scene, allows; mode 'run': check does not see it."""
    def keep(make):
        KINDS[make.__name__] = (make, most, options, mode)
        return make
    return keep


def lines(n, pattern):
    return ''.join([pattern.replace('%i', str(i)) + '\n' for i in range(1, n + 1)])


def block(name, nx, ny, x, y, width=1.0, height=1.0, more=''):
    return (f'*BLOCK, TYPE=CPE4, ELSET={name}, NX={nx}, NY={ny}\n{x}, {y}\n{x + width}, {y}\n{x + width}, {y + height}\n'
            f'{x}, {y + height}\n{more}')


STEP = '*STEP\n*STATIC\n*DSLOAD\nUP-TOP, P, 1.\n'


def scene(heading='growth\n', mesh='', model='', in_step='', steps='', first='', nx=2, ny=2):
    return (first + '*HEADING\n' + heading + block('LOW', nx, ny, 0, 0) + block('UP', nx, ny, 0, 1) + mesh
            + '*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=LOW, MATERIAL=M\n*SOLID SECTION, ELSET=UP, MATERIAL=M\n'
            + '*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.3\n*CONTACT PAIR, INTERACTION=I\nUP-BOTTOM, LOW-TOP\n'
            + '*BOUNDARY\nLOW-BOTTOM, 1, 2\nUP-LEFT, 1\n' + model + STEP + in_step + '*END STEP\n' + steps)


def deck(text, **files):
    return {'deck.inp': text, **files}


# ---- Text ------------------------------------------------------------------------------------------------------------

@kind()
def heading_lines(n):
    return deck(scene(heading=lines(n, 'a line %i of the heading')))


@kind(100000, ('--report',), 'run')
def heading_lines_report(n):
    return deck(scene(heading=lines(n, 'a line %i of the heading')))


@kind(10000000)
def heading_long_line(n):
    return deck(scene(heading='x' * n + '\n'))


@kind(10000000)
def blank_lines(n):
    return deck(scene(mesh='\n' * n))


@kind(10000000)
def lines_of_one_letter(n):
    return deck(scene(heading='x\n' * n))


@kind()
def comment_lines(n):
    return deck(scene(mesh=lines(n, '** a comment %i')))


@kind()
def one_line_of_items(n):
    return deck(scene(mesh='*NSET, NSET=ALL\n' + ','.join(['1'] * n) + '\n'))


@kind(100000)
def continued_keyword(n):
    return deck(scene(mesh='*NSET,\n' + lines(n, 'INTERNAL,') + 'NSET=B\n1\n'))


@kind(100000)
def includes(n):
    return deck(scene(mesh=lines(n, '*INCLUDE, INPUT=one.inc')), **{'one.inc': '** nothing\n'})


@kind(100000)
def includes_of_sets(n):
    return deck(scene(mesh='*NSET, NSET=A\n' + lines(n, '*INCLUDE, INPUT=one.inc')), **{'one.inc': '1, 2\n'})


@kind(100000)
def include_with_includes(n):
    return deck(scene(mesh='*INCLUDE, INPUT=list.inc\n'), **{'list.inc': lines(n, '*INCLUDE, INPUT=one.inc'),
                'one.inc': '** nothing\n'})


# ---- Parameters ------------------------------------------------------------------------------------------------------

@kind()
def parameters(n):
    return deck(scene(first='*PARAMETER\n' + lines(n, 'p%i = %i')))


@kind()
def parameters_in_chain(n):
    return deck(scene(first='*PARAMETER\np0 = 1\n' + ''.join([f'p{i} = p{i - 1} + 1\n' for i in range(1, n + 1)])))


@kind()
def parameters_used(n):
    return deck(scene(first='*PARAMETER\n' + lines(n, 'p%i = %i'), mesh='*NODE\n' + lines(n, '7%i, <p%i>, <2*p%i>')))


@kind()
def one_parameter_used(n):
    return deck(scene(first='*PARAMETER\np = 1\n', mesh='*NODE\n' + lines(n, '7%i, <p>, <2*p>')))


@kind()
def sum_of_terms(n):
    return deck(scene(first='*PARAMETER\np = ' + '+'.join(['1'] * n) + '\n'))


@kind()
def sum_of_names(n):
    return deck(scene(first='*PARAMETER\nq = 1\np = ' + '+'.join(['q'] * n) + '\n'))


@kind()
def product_of_sums(n):
    return deck(scene(first='*PARAMETER\np = ' + '*'.join(['(1+0)'] * n) + '\n'))


@kind()
def nested_parentheses(n):
    return deck(scene(first='*PARAMETER\np = ' + '(' * n + '1' + ')' * n + '\n'))


@kind()
def many_minus_signs(n):
    return deck(scene(first='*PARAMETER\np = 1' + ' -1 +1' * n + '\n'))


@kind()
def max_of_terms(n):
    return deck(scene(first='*PARAMETER\np = ' + 'max(1,' * n + '2' + ')' * n + '\n'))


@kind()
def function_of_terms(n):
    return deck(scene(in_step='*BOUNDARY, FUNCTION\nUP-RIGHT, 1, 1, ' + '+'.join(['0*x'] * n) + '\n'))


# ---- Mesh ------------------------------------------------------------------------------------------------------------

@kind()
def node_lines(n):
    return deck(scene(mesh='*NODE\n' + lines(n, '7%i, %i., 2.')))


@kind(300000)
def node_cards(n):
    return deck(scene(mesh=lines(n, '*NODE\n7%i, %i., 2.')))


@kind(300000)
def node_cards_one_set(n):
    return deck(scene(mesh=lines(n, '*NODE, NSET=A\n7%i, %i., 2.')))


@kind(300000)
def node_cards_own_sets(n):
    return deck(scene(mesh=lines(n, '*NODE, NSET=A%i\n7%i, %i., 2.')))


def ngen_nodes(n):
    return '*NODE\n' + ''.join([f'{1000 + 2 * i}, {i}., 5.\n' for i in range(n + 1)])


def ngen_pairs(n, before):
    return ''.join([f'{before}{1000 + 2 * i}, {1002 + 2 * i}\n' for i in range(n)])


@kind()
def ngen_lines(n):
    return deck(scene(mesh=ngen_nodes(n) + '*NGEN\n' + ngen_pairs(n, '')))


@kind(300000)
def ngen_cards(n):
    return deck(scene(mesh=ngen_nodes(n) + ngen_pairs(n, '*NGEN, NSET=A\n')))


@kind()
def ngen_wide(n):
    return deck(scene(mesh='*NODE\n1000, 0., 5.\n%d, 1., 5.\n*NGEN, NSET=A\n1000, %d\n' % (1000 + n, 1000 + n)))


@kind(30000)
def nfill_cards(n):
    return deck(scene(mesh='*NODE\n' + ''.join([f'{4 * i}, {i}., 5.\n{4 * i + 2}, {i}., 6.\n' for i in range(20, n + 20)])
                      + ''.join([f'*NSET, NSET=P{i}\n{4 * i}\n*NSET, NSET=Q{i}\n{4 * i + 2}\n*NFILL, NSET=A\nP{i}, Q{i}, 2, 1\n' for i in range(20, n + 20)])))


@kind(100000)
def ncopy_cards(n):
    return deck(scene(mesh='*NODE, NSET=P\n1000, 0., 5.\n' + lines(n,
                '*NCOPY, OLD SET=P, SHIFT, CHANGE NUMBER=7%i, NEW SET=Q\n1., 0.')))


@kind(100000)
def ncopy_cards_sets(n):
    return deck(scene(mesh='*NODE, NSET=P\n1000, 0., 5.\n' + lines(n,
                '*NCOPY, OLD SET=P, SHIFT, CHANGE NUMBER=7%i, NEW SET=Q%i\n1., 0.')))


@kind()
def ncopy_multiple(n):
    return deck(scene(mesh='*NODE, NSET=P\n1000, 0., 5.\n*NCOPY, OLD SET=P, SHIFT, CHANGE NUMBER=1, NEW SET=Q, MULTIPLE=%d\n1., 0.\n0.,0.,0.,0.,0.,1.,1.\n' % n))


def grid(n, element_cards='*ELEMENT, TYPE=CPE4, ELSET=G', each=False):
    """A strip of n elements by *NODE and *ELEMENT."""
    nodes = '*NODE\n' + ''.join([f'{1000 + 2 * i}, {i}., 5.\n{1001 + 2 * i}, {i}., 6.\n' for i in range(n + 1)])
    elements = [f'{1000 + i}, {1000 + 2 * i}, {1002 + 2 * i}, {1003 + 2 * i}, {1001 + 2 * i}\n' for i in range(n)]
    if each:
        body = ''.join([element_cards.replace('%i', str(i)) + '\n' + e for i, e in enumerate(elements)])
    else:
        body = element_cards + '\n' + ''.join(elements)
    return nodes + body


HOLD = '*SOLID SECTION, ELSET=G, MATERIAL=M\n*BOUNDARY\n1000, 1, 2\n1001, 1\n'


@kind(300000)
def element_lines(n):
    return deck(scene(mesh=grid(n), model=HOLD))


@kind(100000)
def element_cards(n):
    return deck(scene(mesh=grid(n, each=True), model=HOLD))


@kind(100000)
def element_cards_own_sets(n):
    return deck(scene(mesh=grid(n, '*ELEMENT, TYPE=CPE4, ELSET=G%i', True) + '*ELSET, ELSET=G, GENERATE\n1000, %d\n' % (999 + n),
                      model=HOLD))


@kind(30000)
def elcopy_cards(n):
    nodes = '*NODE\n' + ''.join([f'{1000 + 2 * i}, {i}., 5.\n{1001 + 2 * i}, {i}., 6.\n' for i in range(n + 2)])
    return deck(scene(mesh=nodes + '*ELEMENT, TYPE=CPE4, ELSET=G\n1000, 1000, 1002, 1003, 1001\n*ELSET, ELSET=F\n1000\n'
                      + ''.join([f'*ELCOPY, OLD SET=F, ELEMENT SHIFT={i}, SHIFT NODES={2 * i}, NEW SET=G\n' for i in range(1, n
                          + 1)]),
                      model=HOLD))


@kind(100000)
def elgen_lines(n):
    nodes = '*NODE\n' + ''.join([f'{1000 + 2 * i}, {i}., 5.\n{1001 + 2 * i}, {i}., 6.\n' for i in range(2 * n + 2)])
    elements = '*ELEMENT, TYPE=CPE4, ELSET=G\n' + ''.join(
        [f'{1000 + 2 * i}, {1000 + 4 * i}, {1002 + 4 * i}, {1003 + 4 * i}, {1001 + 4 * i}\n' for i in range(n)])
    return deck(scene(mesh=nodes + elements + ''.join([f'*ELGEN, ELSET=G\n{1000 + 2 * i}, 2, 2, 1\n' for i in range(n)]),
                model=HOLD))


@kind(100000)
def blocks(n):
    body = ''.join([block(f'B{i}', 1, 1, 5 + 2 * i, 0) for i in range(n)])
    return deck(scene(mesh=body + lines(n, '*ELSET, ELSET=G\nB%i').replace('B%d\n' % n, 'B0\n'),
                      model='*SOLID SECTION, ELSET=G, MATERIAL=M\n' + '*BOUNDARY\n' + ''.join([f'B{i}-BOTTOM, 1, 2\n'
                          for i in range(n)])))


@kind(100000)
def blocks_merged(n):
    body = block('B0', 1, 1, 5, 0) + ''.join(
        [block(f'B{i}', 1, 1, 5 + i, 0).replace('NY=1', f'NY=1, MERGE=B{i - 1}') for i in range(1, n)])
    return deck(scene(mesh=body + '*ELSET, ELSET=G\n' + ''.join([f'B{i}\n' for i in range(n)]),
                      model='*SOLID SECTION, ELSET=G, MATERIAL=M\n*BOUNDARY\nB0-BOTTOM, 1, 2\n'))


@kind()
def block_copies(n):
    return deck(scene(mesh=block('B', 1, 1, 5, 0, more=f'COPY, {n}, 1, 2., 2.\n'),
                      model='*SOLID SECTION, ELSET=B, MATERIAL=M\n*BOUNDARY\nB, 1, 2\n'))


@kind()
def block_elements(n):
    side = max(1, int(n**0.5))
    return deck(scene(mesh=block('B', side, side, 5, 0), model='*SOLID SECTION, ELSET=B, MATERIAL=M\n*BOUNDARY\nB, 1, 2\n'))


# ---- Sets ------------------------------------------------------------------------------------------------------------

@kind(300000)
def node_sets(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\n1, 2')))


@kind(300000)
def node_sets_long_names(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=' + 'A' * 60 + '%i\n1, 2')))


@kind(300000)
def one_set_grown(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A\n1, 2')))


@kind(300000)
def one_set_of_nodes_grown(n):
    return deck(scene(mesh='*NODE\n' + lines(n, '7%i, %i., 2.') + lines(n, '*NSET, NSET=A\n7%i')))


@kind()
def set_lines(n):
    return deck(scene(mesh='*NSET, NSET=A\n' + lines(n, '1, 2')))


@kind()
def set_generate_lines(n):
    return deck(scene(mesh='*NSET, NSET=A, GENERATE\n' + lines(n, '1, 9')))


@kind(300000)
def set_generate_cards(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i, GENERATE\n1, 9')))


@kind(300000)
def set_generate_cards_one_set(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A, GENERATE\n1, 9')))


@kind(1000000)
def set_generate_wide(n):
    return deck(scene(mesh='*NODE\n' + lines(n, '7%i, %i., 2.') + '*NSET, NSET=A\n' + lines(n, '7%i')))


@kind(100000)
def set_of_sets(n):
    return deck(scene(mesh='*NSET, NSET=A\n' + lines(n, 'LOW, UP')))


@kind(100000)
def sets_in_chain(n):
    return deck(scene(mesh='*NSET, NSET=A0\n1\n' + ''.join([f'*NSET, NSET=A{i}\nA{i - 1}\n' for i in range(1, n + 1)])))


@kind(10000)
def elsets_of_a_block(n):
    return deck(scene(mesh=lines(n, '*ELSET, ELSET=A%i\nLOW'), nx=100, ny=100))


@kind(10000)
def nsets_of_a_block(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\nLOW'), nx=100, ny=100))


@kind(10000)
def elset_names_a_block(n):
    return deck(scene(mesh='*ELSET, ELSET=A\n' + lines(n, 'LOW'), nx=100, ny=100))


@kind(10000)
def nset_names_a_block(n):
    return deck(scene(mesh='*NSET, NSET=A\n' + lines(n, 'LOW'), nx=100, ny=100))


@kind(10000)
def elset_cards_name_a_block(n):
    return deck(scene(mesh=lines(n, '*ELSET, ELSET=A\nLOW'), nx=100, ny=100))


@kind(10000)
def elsets_that_generate_a_block(n):
    return deck(scene(mesh=lines(n, '*ELSET, ELSET=A%i, GENERATE\n1, 10000'), nx=100, ny=100))


# ---- Surfaces --------------------------------------------------------------------------------------------------------

@kind(10000)
def surfaces_of_a_block(n):
    return deck(scene(mesh=lines(n, '*SURFACE, NAME=S%i\nLOW'), nx=100, ny=100))


@kind(10000)
def surfaces_of_a_side(n):
    return deck(scene(mesh=lines(n, '*SURFACE, NAME=S%i\nLOW, S1'.replace('LOW', 'E')).replace('*SURFACE',
                '*ELSET, ELSET=E, GENERATE\n1, 100\n*SURFACE', 1), nx=100, ny=100))


@kind(100000)
def surfaces(n):
    return deck(scene(mesh=lines(n, '*SURFACE, NAME=S%i\n1, S1')))


@kind(100000)
def node_surfaces(n):
    return deck(scene(mesh=lines(n, '*SURFACE, NAME=S%i, TYPE=NODE\nLOW-BOTTOM')))


@kind(100000)
def node_surface_lines(n):
    return deck(scene(mesh='*SURFACE, NAME=S, TYPE=NODE\n' + lines(n, 'LOW-BOTTOM')))


@kind(100000)
def segments_surfaces(n):
    return deck(scene(model=lines(n, '*SURFACE, NAME=F%i, TYPE=SEGMENTS\nSTART, 0., -9.\nLINE, 1., -9.')))


@kind(100000)
def segments_of_a_surface(n):
    return deck(scene(model='*SURFACE, NAME=F, TYPE=SEGMENTS\nSTART, 0., -9.\n' + lines(n, 'LINE, %i., -9.')))


@kind(1000)
def surface_faces(n):
    return deck(scene(mesh='*SURFACE, NAME=S\n' + lines(4 * n, '%i, S1'), nx=4 * n, ny=1))


# ---- Materials, sections, laws ---------------------------------------------------------------------------------------

@kind(100000)
def materials(n):
    return deck(scene(model=lines(n, '*MATERIAL, NAME=M%i\n*ELASTIC\n1000., 0.3')))


@kind(10000)
def materials_used(n):
    return deck(scene(mesh=grid(n, '*ELEMENT, TYPE=CPE4, ELSET=G%i', True),
                      model=''.join([f'*MATERIAL, NAME=M{i}\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=G{i}, MATERIAL=M{i}\n'
                          for i in range(n)])
                      + '*BOUNDARY\n1000, 1, 2\n1001, 1\n'))


@kind(100000)
def elastic_lines(n):
    return deck(scene(model='*MATERIAL, NAME=N\n*ELASTIC\n' + lines(n, '1000., 0.3, %i.')))


@kind(100000)
def orientations(n):
    return deck(scene(model=lines(n, '*ORIENTATION, NAME=O%i\n1., 0., 0., 0., 1., 0.')))


@kind(100000)
def interactions(n):
    return deck(scene(model=lines(n, '*SURFACE INTERACTION, NAME=I%i\n*FRICTION\n0.3')))


@kind(100000)
def nodal_thickness_lines(n):
    return deck(scene(model='*NODAL THICKNESS\n' + lines(n, 'LOW, 1.')))


@kind(100000)
def initial_temperature_lines(n):
    return deck(scene(model='*INITIAL CONDITIONS, TYPE=TEMPERATURE\n' + lines(n, 'LOW, 1.')))


@kind(100000)
def initial_temperature_cards(n):
    return deck(scene(model=lines(n, '*INITIAL CONDITIONS, TYPE=TEMPERATURE\nLOW, 1.')))


# ---- Contact, rows ---------------------------------------------------------------------------------------------------

def towers(n, between):
    """n pairs of blocks, one of elements on the other."""
    body = ''.join([block(f'A{i}', 1, 1, 5 + 2 * i, 0) + block(f'B{i}', 1, 1, 5 + 2 * i, 1) for i in range(n)])
    return deck(scene(mesh=body + '*ELSET, ELSET=G\n' + ''.join([f'A{i}, B{i}\n' for i in range(n)]),
                      model='*SOLID SECTION, ELSET=G, MATERIAL=M\n*BOUNDARY\n'
                      + ''.join([f'A{i}-BOTTOM, 1, 2\nB{i}-LEFT, 1\n' for i in range(n)]) + between,
                      in_step=''.join([f'*DSLOAD\nB{i}-TOP, P, 1.\n' for i in range(n)])))


@kind(10000)
def contact_pairs(n):
    return towers(n, ''.join([f'*CONTACT PAIR, INTERACTION=I\nB{i}-BOTTOM, A{i}-TOP\n' for i in range(n)]))


@kind(10000)
def contact_found(n):
    return deck(
        towers(n, '*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n, , I\n')['deck.inp'].replace(
            '*CONTACT PAIR, INTERACTION=I\nUP-BOTTOM, LOW-TOP\n', ''))


@kind(10000)
def contact_rules(n):
    rules = ('*CONTACT\n*CONTACT INCLUSIONS\n' + lines(n, 'UP-BOTTOM, LOW-TOP') + '*CONTACT EXCLUSIONS\n' + lines(n,
             'UP-TOP, LOW-BOTTOM')
             + '*CONTACT PROPERTY ASSIGNMENT\n' + lines(n, ', , I'))
    return deck(scene(model=rules).replace('*CONTACT PAIR, INTERACTION=I\nUP-BOTTOM, LOW-TOP\n', ''))


@kind(10000)
def clearance_cards(n):
    return towers(n, ''.join([f'*CONTACT PAIR, INTERACTION=I\nB{i}-BOTTOM, A{i}-TOP\n*CLEARANCE, SLAVE=B{i}-BOTTOM, MASTER=A{i}-TOP, VALUE=0.\n'
                              for i in range(n)]))


@kind(100000)
def clearance_lines(n):
    return deck(scene(model='*CLEARANCE, SLAVE=UP-BOTTOM, MASTER=LOW-TOP, TABULAR\n' + lines(n, 'UP-BOTTOM, 0.')))


@kind(10000)
def ties(n):
    return towers(n, ''.join([f'*TIE, NAME=T{i}\nB{i}-BOTTOM, A{i}-TOP\n' for i in range(n)]))


@kind(10000)
def equations(n):
    return towers(n, '*EQUATION\n'
                  + ''.join([f'2\nB{i}-BOTTOM, 1, 1., A{i}-TOP, 1, -1.\n2\nB{i}-BOTTOM, 2, 1., A{i}-TOP, 2, -1.\n'
                      for i in range(n)]))


@kind(10000)
def equation_cards(n):
    return towers(n, ''.join([f'*EQUATION\n2\nB{i}-BOTTOM, 1, 1., A{i}-TOP, 1, -1.\n*EQUATION\n2\nB{i}-BOTTOM, 2, 1., A{i}-TOP, 2, -1.\n' for i in range(n)]))


@kind(10000)
def equation_of_terms(n):
    side = '*NODE\n' if n < 1 else ''
    return deck(scene(mesh=side + block('B', n, 1, 5, 0, width=float(n)),
                      model='*SOLID SECTION, ELSET=B, MATERIAL=M\n*BOUNDARY\nB-BOTTOM, 1, 2\n*EQUATION\n%d\n' % n
                      + ''.join([f'{18 + n + 1 + i}, 1, 1.\n' for i in range(1, n + 1)])))


@kind(10000)
def transforms(n):
    return towers(n, ''.join([f'*TRANSFORM, NSET=B{i}-LEFT\n1., 0., 0., 0., 1., 0.\n*TIE, NAME=T{i}\nB{i}-BOTTOM, A{i}-TOP\n'
                  for i in range(n)]))


@kind(10000)
def springs(n):
    return towers(n, ''.join([f'*ELEMENT, TYPE=SPRING1, ELSET=S{i}\n{10**6 + i}, B{i}\n'.replace(f', B{i}\n',
                  f', {18 + 8 * i + 5}\n')
                              + f'*SPRING, ELSET=S{i}\n2\n1.\n*TIE, NAME=T{i}\nB{i}-BOTTOM, A{i}-TOP\n' for i in range(n)]))


@kind(10000)
def rigid_floors(n):
    body = ''.join([block(f'B{i}', 1, 1, 5 + 2 * i, 1) for i in range(n)])
    return deck(scene(mesh=body + '*ELSET, ELSET=G\n' + ''.join([f'B{i}\n' for i in range(n)]),
                      model='*SOLID SECTION, ELSET=G, MATERIAL=M\n' + ''.join(
                          [f'*SURFACE, NAME=F{i}, TYPE=SEGMENTS\nSTART, {4 + 2 * i}., 1.\nLINE, {7 + 2 * i}., 1.\n'
                           f'*RIGID BODY, ANALYTICAL SURFACE=F{i}\n*CONTACT PAIR, INTERACTION=I\nB{i}-BOTTOM, F{i}\n*BOUNDARY\nB{i}-LEFT, 1\n'
                           for i in range(n)]),
                      in_step=''.join([f'*DSLOAD\nB{i}-TOP, P, 1.\n' for i in range(n)])))


@kind(100000)
def rigid_bodies(n):
    nodes = ''.join([f'*NODE\n{10**6 + i}, {5.5 + 2 * i}, 0.5\n' for i in range(n)])
    body = ''.join([block(f'B{i}', 1, 1, 5 + 2 * i, 0) for i in range(n)])
    return deck(scene(mesh=body + nodes + '*ELSET, ELSET=G\n' + ''.join([f'B{i}\n' for i in range(n)]),
                      model='*SOLID SECTION, ELSET=G, MATERIAL=M\n' + ''.join(
                          [f'*RIGID BODY, REF NODE={10**6 + i}, NSET=B{i}-TOP\n*BOUNDARY\nB{i}-BOTTOM, 1, 2\n'
                              for i in range(n)])))


# ---- Parts -----------------------------------------------------------------------------------------------------------

def assembly(parts, instances):
    return ('*HEADING\nparts\n' + parts + '*ASSEMBLY, NAME=ALL\n' + instances
            + '*END ASSEMBLY\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n')


def part(name):
    return (f'*PART, NAME={name}\n*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*ELEMENT, TYPE=CPE4, ELSET=E\n1, 1, 2, 3, 4\n'
            '*NSET, NSET=N\n1, 2, 3, 4\n*SOLID SECTION, ELSET=E, MATERIAL=M\n*END PART\n')


@kind(300000)
def instances(n):
    inst = ''.join([f'*INSTANCE, NAME=I{i}, PART=P\n{2 * i}., 0.\n*END INSTANCE\n' for i in range(n)])
    return deck(assembly(part('P'), inst) + '*BOUNDARY\n' + ''.join([f'I{i}.N, 1, 2\n' for i in range(n)])
                + '*STEP\n*STATIC\n*CLOAD\nI1.3, 1, 1.\n*END STEP\n')


@kind(300000)
def parts(n):
    inst = ''.join([f'*INSTANCE, NAME=I{i}, PART=P{i}\n{2 * i}., 0.\n*END INSTANCE\n' for i in range(n)])
    return deck(assembly(''.join([part(f'P{i}') for i in range(n)]), inst) + '*BOUNDARY\n' + ''.join([f'I{i}.N, 1, 2\n'
                for i in range(n)])
                + '*STEP\n*STATIC\n*CLOAD\nI1.3, 1, 1.\n*END STEP\n')


# ---- Supports, loads, steps ------------------------------------------------------------------------------------------

@kind(300000)
def boundary_lines(n):
    return deck(scene(model='*BOUNDARY\n' + lines(n, 'LOW-BOTTOM, 1, 2')))


@kind(100000)
def boundary_cards(n):
    return deck(scene(model=lines(n, '*BOUNDARY\nLOW-BOTTOM, 1, 2')))


@kind(300000)
def boundary_sets(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\n1, 2'), model='*BOUNDARY\n' + lines(n, 'A%i, 1')))


@kind(300000)
def boundary_nodes(n):
    return deck(scene(mesh=block('B', n, 1, 5, 0, width=float(n)), model='*SOLID SECTION, ELSET=B, MATERIAL=M\n*BOUNDARY\n'
                + lines(n, '%i, 1, 2')
                      .replace('\n', '\n')).replace('\n%d, 1, 2\n', '\n'))


@kind(300000)
def step_boundary_sets(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\n1, 2'), in_step='*BOUNDARY\n' + lines(n, 'A%i, 1')))


@kind(300000)
def cload_lines(n):
    return deck(scene(in_step='*CLOAD\n' + lines(n, 'UP, 2, -1e-6')))


@kind(100000)
def cload_cards(n):
    return deck(scene(in_step=lines(n, '*CLOAD\nUP, 2, -1e-6')))


@kind(300000)
def cload_sets(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\n12, 13'), in_step='*CLOAD\n' + lines(n, 'A%i, 2, -1e-6')))


@kind(300000)
def dload_lines(n):
    return deck(scene(in_step='*DLOAD\n' + lines(n, 'UP, BY, -1e-6')))


@kind(300000)
def dload_sets(n):
    return deck(scene(mesh=lines(n, '*ELSET, ELSET=A%i\n5, 6'), in_step='*DLOAD\n' + lines(n, 'A%i, BY, -1e-6')))


@kind(300000)
def dsload_lines(n):
    return deck(scene(in_step='*DSLOAD\n' + lines(n, 'UP-TOP, P, 1e-6')))


@kind(100000)
def dsload_surfaces(n):
    return deck(scene(mesh=lines(n, '*SURFACE, NAME=S%i\n7, S3'), in_step='*DSLOAD\n' + lines(n, 'S%i, P, 1e-6')))


@kind(100000)
def temperature_lines(n):
    return deck(scene(in_step='*TEMPERATURE\n' + lines(n, 'LOW, 1.')))


@kind(100000)
def temperature_cards(n):
    return deck(scene(in_step=lines(n, '*TEMPERATURE\nLOW, 1.')))


@kind(100000)
def amplitudes(n):
    return deck(scene(model=lines(n, '*AMPLITUDE, NAME=A%i\n0., 0., 1., 1.')))


@kind(100000)
def amplitude_points(n):
    return deck(scene(model='*AMPLITUDE, NAME=A\n' + lines(n, '%i., 1.')))


@kind(10000)
def amplitudes_used(n):
    return deck(scene(model=lines(n, '*AMPLITUDE, NAME=A%i\n0., 0., 1., 1.'), in_step=lines(n,
                '*CLOAD, AMPLITUDE=A%i\n13, 2, -1e-6')))


@kind(10000)
def empty_steps(n):
    return deck(scene(steps=lines(n, '*STEP\n*STATIC\n*END STEP')))


@kind(3000)
def steps_with_loads(n):
    return deck(scene(steps=lines(n, '*STEP\n*STATIC\n*DSLOAD\nUP-TOP, P, 1.\n*CLOAD\n13, 2, -1e-3\n*END STEP')))


@kind(3000)
def steps_with_supports(n):
    return deck(scene(steps=lines(n, '*STEP\n*STATIC\n*BOUNDARY\nLOW-BOTTOM, 1, 2, 0.\n*END STEP')))


@kind(3000)
def steps_with_prints(n):
    return deck(scene(steps=lines(n,
                '*STEP\n*STATIC\n*NODE PRINT\nU, RF\n*EL PRINT\nS\n*CONTACT PRINT\n*BODY PRINT\n*JOINT PRINT\n*END STEP')))


@kind(3000)
def increments(n):
    return deck(scene(steps='*STEP, INC=%d\n*STATIC\n%r, 1., 1e-9, %r\n*DSLOAD\nUP-TOP, P, 2.\n*NODE PRINT, FREQUENCY=1\nU\n*END STEP\n'
                      % (2 * n, 1.0 / n, 1.0 / n)))


@kind(100000)
def print_requests(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\n1, 2'), in_step=lines(n, '*NODE PRINT, NSET=A%i\nU')))


@kind(100000)
def el_print_requests(n):
    return deck(scene(mesh=lines(n, '*ELSET, ELSET=A%i\n1, 2'), in_step=lines(n, '*EL PRINT, ELSET=A%i\nS')))


@kind(100000)
def file_requests(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\n1, 2'), in_step=lines(n, '*NODE FILE, NSET=A%i\nU')))


@kind(100000)
def print_variables(n):
    return deck(scene(in_step='*NODE PRINT\n' + lines(n, 'U, RF')))


@kind(10000)
def section_prints(n):
    return deck(scene(in_step=lines(n, '*SECTION PRINT, NAME=C%i\n-1., 0.3, 2., 0.3')))


@kind(100000)
def controls_cards(n):
    return deck(scene(in_step=lines(n, '*CONTROLS, MAXIT=200')))


@kind(100000)
def harmless_keywords(n):
    return deck(scene(in_step=lines(n, '*CONTROLS, PARAMETERS=FIELD\n1., 2.')))


@kind(100000)
def loads_replaced(n):
    load = '*DLOAD\n' + lines(n, 'A%i, BY, -1e-6')
    return deck(scene(mesh=lines(n, '*ELSET, ELSET=A%i\n5, 6'), in_step=load, steps='*STEP\n*STATIC\n' + load + '*END STEP\n'))


@kind(100000)
def forces_replaced(n):
    load = '*CLOAD\n' + lines(n, 'A%i, 2, -1e-6')
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\n12, 13'), in_step=load, steps='*STEP\n*STATIC\n' + load + '*END STEP\n'))


@kind(100000)
def supports_replaced(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\n1, 2'), in_step='*BOUNDARY\n' + lines(n, 'A%i, 1'),
                      steps='*STEP\n*STATIC\n*BOUNDARY\n' + lines(n, 'A%i, 1') + '*END STEP\n'))


@kind(3000)
def steps_and_amplitudes(n):
    return deck(scene(model=lines(n, '*AMPLITUDE, NAME=A%i\n0., 0., 1., 1.'),
                      steps=''.join([f'*STEP\n*STATIC\n*CLOAD, AMPLITUDE=A{i}\n13, 2, -1e-6\n*END STEP\n' for i in range(1, n
                          + 1)])))


@kind(100000)
def line_elements(n):
    nodes = '*NODE\n' + ''.join([f'{1000 + i}, {0.001 * i}, 5.\n' for i in range(n + 1)])
    return deck(scene(mesh=nodes + ''.join([f'*ELEMENT, TYPE=T3D2, ELSET=L{i}\n{10**6 + i}, {1000 + i}, {1001 + i}\n'
                for i in range(n)])))


@kind(1000000)
def line_elements_lines(n):
    nodes = '*NODE\n' + ''.join([f'{1000 + i}, {0.001 * i}, 5.\n' for i in range(n + 1)])
    return deck(scene(mesh=nodes + '*ELEMENT, TYPE=T3D2, ELSET=L\n' + ''.join([f'{10**7 + i}, {1000 + i}, {1001 + i}\n'
                for i in range(n)])))


@kind(100000)
def clearances_of_nodes(n):
    return deck(scene(model='*CLEARANCE, SLAVE=UP-BOTTOM, MASTER=LOW-TOP, TABULAR\n'
                      + ''.join([f'{(n + 1) * 2 + i}, 0.\n' for i in range(1, n + 2)]), nx=n, ny=1))


@kind(10000)
def friction_of_pairs(n):
    return towers(n, ''.join([f'*SURFACE INTERACTION, NAME=J{i}\n*FRICTION\n0.3\n*CONTACT PAIR, INTERACTION=J{i}\nB{i}-BOTTOM, A{i}-TOP\n'
                              for i in range(n)]))


# ---- Gmsh ------------------------------------------------------------------------------------------------------------

def gmsh(physical='', entities='', nodes='', elements=''):
    return ('$MeshFormat\n4.1 0 8\n$EndMeshFormat\n' + physical + entities + nodes + elements)


SQUARE_NODES = '$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n5 0 0\n6 0 0\n6 1 0\n5 1 0\n$EndNodes\n'
SQUARE_ELEMENTS = '$Elements\n1 1 1 1\n2 1 3 1\n1 1 2 3 4\n$EndElements\n'
SURFACE_ENTITY = '$Entities\n0 0 1 0\n1 5 0 0 6 1 0 %s 0\n$EndEntities\n'
READ_MESH = '*INCLUDE, INPUT=mesh.msh, TYPE=GMSH, ELEMENTS=CPE\n'


def with_mesh(text, model='*SOLID SECTION, ELSET=G1, MATERIAL=M\n*BOUNDARY\nG1, 1, 2\n'):
    return deck(scene(mesh=READ_MESH, model=model), **{'mesh.msh': text})


@kind(1000000)
def gmsh_groups_of_one_entity(n):
    names = '$PhysicalNames\n1\n2 1 "G1"\n$EndPhysicalNames\n'
    return with_mesh(gmsh(names, SURFACE_ENTITY % (f'{n} ' + ' '.join([str(i) for i in range(1, n + 1)])), SQUARE_NODES,
                     SQUARE_ELEMENTS))


@kind(300000)
def gmsh_names(n):
    names = '$PhysicalNames\n%d\n' % n + lines(n, '2 %i "G%i"') + '$EndPhysicalNames\n'
    return with_mesh(gmsh(names, SURFACE_ENTITY % '1 1', SQUARE_NODES, SQUARE_ELEMENTS))


@kind(100000)
def gmsh_named_groups(n):
    names = '$PhysicalNames\n%d\n' % n + lines(n, '2 %i "G%i"') + '$EndPhysicalNames\n'
    return with_mesh(gmsh(names, SURFACE_ENTITY % (f'{n} ' + ' '.join([str(i) for i in range(1, n + 1)])), SQUARE_NODES,
                     SQUARE_ELEMENTS))


@kind(100000)
def gmsh_entities(n):
    names = '$PhysicalNames\n1\n2 1 "G1"\n$EndPhysicalNames\n'
    entities = '$Entities\n0 0 %d 0\n' % n + lines(n, '%i 5 0 0 6 1 0 1 1 0') + '$EndEntities\n'
    nodes = '$Nodes\n%d %d 1 %d\n' % (n, 4 * n, 4 * n) + ''.join(
        [f'2 {i + 1} 0 4\n{4 * i + 1}\n{4 * i + 2}\n{4 * i + 3}\n{4 * i + 4}\n{5 + 2 * i} 0 0\n{6 + 2 * i} 0 0\n{6 + 2 * i} 1 0\n{5 + 2 * i} 1 0\n'
         for i in range(n)]) + '$EndNodes\n'
    elements = '$Elements\n%d %d 1 %d\n' % (n, n, n) + ''.join(
        [f'2 {i + 1} 3 1\n{i + 1} {4 * i + 1} {4 * i + 2} {4 * i + 3} {4 * i + 4}\n' for i in range(n)]) + '$EndElements\n'
    return with_mesh(gmsh(names, entities, nodes, elements))


@kind(100000)
def gmsh_entity_groups(n):
    names = '$PhysicalNames\n%d\n' % n + lines(n, '2 %i "G%i"') + '$EndPhysicalNames\n'
    made = gmsh_entities(n)['mesh.msh']
    made = made[made.index('$Entities'):].replace(' 0 1 1 0\n', ' 0 1 1 0\n')
    entities = '$Entities\n0 0 %d 0\n' % n + lines(n, '%i 5 0 0 6 1 0 1 %i 0') + '$EndEntities\n'
    rest = made[made.index('$Nodes'):]
    sets = '*ELSET, ELSET=GG\n' + lines(n, 'G%i')
    return deck(scene(mesh=READ_MESH + sets, model='*SOLID SECTION, ELSET=GG, MATERIAL=M\n*BOUNDARY\n' + lines(n, 'G%i, 1, 2')),
                **{'mesh.msh': gmsh(names, entities, rest)})


@kind(1000)
def gmsh_meshes(n):
    mesh = gmsh('$PhysicalNames\n1\n2 1 "G1"\n$EndPhysicalNames\n', SURFACE_ENTITY % '1 1', SQUARE_NODES, SQUARE_ELEMENTS)
    return deck(scene(mesh=READ_MESH * n, model='*SOLID SECTION, ELSET=G1, MATERIAL=M\n*BOUNDARY\nG1, 1, 2\n'),
                **{'mesh.msh': mesh})


# ---- What is wrong in every line -------------------------------------------------------------------------------------

@kind(100000)
def bad_keywords(n):
    return deck(scene(model=lines(n, '*KEYWORD%i, OPTION=VALUE\n1, 2')))


@kind(100000)
def bad_keywords_one(n):
    return deck(scene(model=lines(n, '*KEYWORD, OPTION=VALUE\n1, 2')))


@kind(100000)
def bad_options(n):
    return deck(scene(model=lines(n, '*NSET, NSET=A%i, OPTION%i=VALUE\n1, 2')))


@kind(100000)
def bad_option_list(n):
    return deck(scene(model='*NSET, NSET=A' + ''.join([f', OPTION{i}=VALUE' for i in range(n)]) + '\n1, 2\n'))


@kind(100000)
def bad_sets(n):
    return deck(scene(mesh=lines(n, '*NSET, NSET=A%i\n1, 2'), model='*BOUNDARY\n' + lines(n, 'B%i, 1, 2')))


@kind(100000)
def bad_surfaces(n):
    return deck(scene(mesh=lines(n, '*SURFACE, NAME=A%i\n1, S1'), model='*CONTACT PAIR, INTERACTION=I\n' + lines(n, 'B%i, C%i')))


@kind(100000)
def bad_materials(n):
    return deck(scene(model=lines(n, '*MATERIAL, NAME=A%i\n*ELASTIC\n1000., 0.3') + lines(n,
                '*SOLID SECTION, ELSET=LOW, MATERIAL=B%i')))


@kind(100000)
def bad_nodes(n):
    return deck(scene(model='*BOUNDARY\n' + lines(n, '7%i00, 1, 2')))


@kind(100000)
def bad_numbers(n):
    return deck(scene(mesh='*NODE\n' + lines(n, '7%i, 1x%i, 0.')))


@kind(100000)
def bad_node_twice(n):
    return deck(scene(mesh='*NODE\n' + lines(n, '1, %i., 0.')))


@kind(100000)
def bad_parameters(n):
    return deck(scene(first='*PARAMETER\n' + lines(n, 'p%i = q%i')))


@kind(100000)
def bad_parameter_twice(n):
    return deck(scene(first='*PARAMETER\n' + lines(n, 'p = %i')))


@kind(100000)
def bad_names(n):
    return deck(scene(first='*PARAMETER\n' + lines(n, 'p%i = 1'), mesh='*NODE\n' + lines(n, '7%i, <q%i>, 0.')))


@kind(100000)
def bad_includes(n):
    return deck(scene(mesh=lines(n, '*INCLUDE, INPUT=none%i.inc')))


@kind(100000)
def bad_data_lines(n):
    return deck(scene(in_step='*STATIC\n' + lines(n, '1., 1.')))


@kind(100000)
def bad_elements(n):
    return deck(scene(mesh='*ELEMENT, TYPE=CPE4, ELSET=G\n' + lines(n, '7%i, 1, 2, 3, 4'),
                model='*SOLID SECTION, ELSET=G, MATERIAL=M\n'))


@kind(100000)
def bad_names_twice(n):
    return deck(scene(model=lines(n, '*MATERIAL, NAME=A\n*ELASTIC\n1000., 0.3')))


@kind(100000)
def bad_pairs_twice(n):
    return deck(scene(model='*CONTACT PAIR, INTERACTION=I\n' + lines(n, 'UP-BOTTOM, LOW-TOP')))


@kind(100000)
def bad_sections_twice(n):
    return deck(scene(model=lines(n, '*SOLID SECTION, ELSET=LOW, MATERIAL=M')))


@kind(100000)
def bad_order(n):
    return deck(scene(in_step=lines(n, '*NSET, NSET=A%i\n1')))
