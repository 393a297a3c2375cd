#!/usr/bin/env python3
"""Writes the table of docs/engine-units.md: what the bias that follows from the map alone leaves on the conformance suite,
beside the bias that engines have by default.

Usage: docs/make_bias_table.py PROGRAM

PROGRAM draws all of it, with its own maps and filters: what an engine does beside its bias is not in the figures. Some five
minutes on two cores. The formula is the program's own (derived_bias of result.json); engines' defaults stand below.
"""
import json
import os
import subprocess
import sys
import tempfile

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'engine-units.md')
BEGIN, END = '<!-- make_bias_table.py writes from here -->\n', '<!-- to here -->\n'
SIZE = '320x180'
LIGHTS = [
    ('sun', ['tilted-plane', 'wall-on-floor', 'floating-box', 'pickets', 'masked-leaf', 'mirrored-node', 'two-sided-sheet', 'grazing-sun'], []),
    ('sun, four cascades', ['long-floor'], ['--technique', 'csm']),
    ('spot', ['spot-rim'], []),
    ('point', ['cube-seams'], ['--technique', 'cube'])]
FILTERS = [
    ('none', []),
    ('2 x 2', ['--technique', 'pcf', '--filter-kernel', 'hardware', '--filter-plane', 'off']),
    ('5 x 5', ['--technique', 'pcf', '--filter-radius', '2.5', '--filter-plane', 'off'])]


def texels(constant, offset):
    return lambda layer: ['--bias', f'{constant}texel', '--normal-offset', str(offset)]


def world(constant, offset):
    return lambda layer: ['--bias', str(constant), '--normal-offset', str(offset)]


# The inverse of the formulas above the table, of what a light has when it is made: documentation of each engine.
DEFAULTS = [
    ('three.js: 0, 0', {light: world(0, 0) for light in ('sun', 'sun, four cascades', 'spot', 'point')}),
    ('Unity (URP): 1, 1', {light: texels(1, 1) for light in ('sun', 'sun, four cascades')}),
    ('Unreal: 0.5, 0.5', {light: lambda layer: ['--bias', '2.5texel', '--slope-bias', str(0.5 * 3 * 2 ** 0.5 * 2.5)] for light in ('sun', 'sun, four cascades')}),
    ('Godot: 0.1, 2', {light: world(0.001, 2) for light in ('sun', 'sun, four cascades')}),
    ('Bevy', {'sun': world(0.02, 1.8), 'sun, four cascades': world(0.02, 1.8), 'spot': world(0.02, 1.8), 'point': world(0.08, 0.6)}),
    ('Babylon.js: 0.00005, 0', {'sun': lambda layer: ['--bias', str(5e-5 * layer['derived']['world'] / layer['derived']['stored']), '--normal-offset', '0']}),
    ('PlayCanvas: 0.05', {light: lambda layer: ['--caster-slope-bias', '0.5', '--bias', '0'] for light in ('sun', 'sun, four cascades', 'spot')}),
    ('Filament: 0.001, 1', {light: world(0.001, 1) for light in ('sun', 'sun, four cascades', 'spot', 'point')})]


def compared(program, scene, options):
    done = subprocess.run([program, 'compare', scene, '--size', SIZE, '--runs', '1', '-q', '--json', '-'] + options, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f'{scene} {" ".join(options)}: {done.stderr.strip()}')
    return json.loads(done.stdout)['lights'][0]


def wrong(program, scene, options):
    """The share that the hard test draws wrong, or with a filter the mean error: what is partly lit is not wrong by half."""
    light = compared(program, scene, options)
    return light['error']['mean_absolute'], light['classes']['acne'] / max(1, light['pixels']['compared'])


def text(values):
    if not values:
        return '–'
    error, acne = (100 * sum(column) / len(values) for column in zip(*values))
    return f'{error:.2g}' + (f' ({acne:.2g})' if acne >= 0.005 else '')


def rows(program, folder):
    subprocess.run([program, 'export', '--suite', os.path.join(folder, 'suite'), '-q'], check=True)
    yield '| light | filter | slope | normal offset | ' + ' | '.join(name for name, _ in DEFAULTS) + ' |'
    yield '|' + '---|' * (4 + len(DEFAULTS))
    for light, scenes, technique in LIGHTS:
        for kind, filtering in FILTERS:
            if technique and filtering:
                continue
            cells = [[] for _ in range(2 + len(DEFAULTS))]
            for scene in scenes:
                path, fixed = os.path.join(folder, 'suite', scene + '.glb'), technique + filtering
                derived = compared(program, path, fixed)['derived_bias']
                constant = ['--bias', f'{derived["constant_texels"]}texel']
                tried = [constant + ['--slope-bias', str(derived['slope'])], constant + ['--normal-offset', str(derived['normal_offset_texels'])]]
                tried += [default[light](derived['layers'][0]) if light in default else None for _, default in DEFAULTS]
                for cell, options in zip(cells, tried):
                    if options is not None:
                        cell.append(wrong(program, path, fixed + options))
            yield f'| {light} | {kind} | ' + ' | '.join(text(cell) for cell in cells) + ' |'
            print(light, kind, file=sys.stderr)


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        table = '\n'.join(rows(program, folder)) + '\n'
    with open(PAGE) as file:
        before, rest = file.read().split(BEGIN)
    with open(PAGE, 'w') as file:
        file.write(before + BEGIN + table + END + rest.split(END)[1])


if __name__ == '__main__':
    main()
