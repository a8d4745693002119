// A library whose preprocessed lines have grown by more than a tenth is named; seconds never fail.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { faults, preprocessing, wordsOf } from './compile-budget.mjs';

const rows = (lines, seconds = 1) => new Map([['vrut_room', { units: 3, lines, cpu_s: seconds }]]);

test('a tenth more lines pass, more do not', () => {
  assert.deepEqual(faults(rows(1000), rows(1100)), []);
  assert.match(faults(rows(1000), rows(1101)).join('\n'), /^vrut_room has 1101 preprocessed lines, more than a tenth above its 1000/);
  assert.deepEqual(faults(rows(1000), rows(10)), []);
});

test('seconds never fail', () => assert.deepEqual(faults(rows(1000, 1), rows(1000, 100)), []));

test('each library has a row, and each row a library', () => {
  assert.match(faults(new Map(), rows(1)).join('\n'), /^vrut_room has no row/);
  assert.match(faults(rows(1), new Map()).join('\n'), /^vrut_room has a row, but is not compiled/);
});

test('the preprocessor gets the compilation without its precompiled header, and makes that of one', () => {
  const words = wordsOf('/usr/bin/ccache c++ -DNAME=\\"a b\\" -O3 -Winvalid-pch -include pch.hxx -MD -MT a.o -MF a.d -o a.o -c a.cpp');
  assert.deepEqual(preprocessing(words), ['c++', '-DNAME="a', 'b"', '-O3', 'a.cpp', '-E', '-P']);
  assert.deepEqual(preprocessing(wordsOf('c++ -x c++-header -include pch.hxx -o pch.gch -c pch.cxx')),
    ['c++', '-x', 'c++-header', '-include', 'pch.hxx', 'pch.cxx', '-E', '-P']);
});
