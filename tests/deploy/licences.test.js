// deploy/debian/copyright against what the program is really made of: the headers that were compiled in, and the libraries
// that are linked.
'use strict';
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const { test } = require('node:test');
const { DEPLOY, linkedLibraries, missing, output, packagesOf } = require('./helpers.js');

const { VRUT_PREVIEW, VRUT_BUILD } = process.env;
const skip = missing('dpkg-query', 'readelf', 'ninja');

/** What the copyright of a package says where it is under a licence, by the licence's SPDX identifier. */
const WORDS = {
  'MIT': /Permission is hereby granted, free of charge, to any person obtaining/,
  'BSL-1.0': /Boost Software License - Version 1\.0/,
  'BSD-3-Clause': /Neither the names? of .* endorse or promote/,
  'Apache-2.0': /Apache License,? (Version )?2\.0/,
  'CC0-1.0': /CC0 Public Domain Dedication/,
  'LGPL-2.1-or-later': /Lesser General Public License .*version 2\.1 .*or .*any later version/i,
  'GPL-2.0-or-later': /General Public License .*version 2 .*or .*any later version/i,
  'GPL-3.0-or-later WITH GCC-exception-3.1': /GCC Runtime Library Exception/i,
  'GPL-2.0-only WITH Linux-syscall-note': /General Public License version 2/,
  'Zlib': /provided 'as-is', without any express/,
  'libpng-2.0': /PNG Reference Library/,
  'libtiff': /the names of Sam Leffler and Silicon Graphics may not be used/,
  'IJG': /Independent JPEG Group/,
};

const oneLine = (text) => text.replace(/^ ?\.?$/gm, '').replace(/\s+/g, ' ');
const copyright = fs.readFileSync(path.join(DEPLOY, 'debian/copyright'), 'utf8');
const paragraphs = copyright.trim().split(/\n\n+/)
  .map((text) => Object.fromEntries([...text.matchAll(/^([\w-]+):((?:.*\n?)(?:[ \t].*\n?)*)/gm)].map(([, key, value]) => [key, value.trim()])));
const listed = paragraphs.filter((paragraph) => paragraph.Package);
const licencesOf = (paragraph) => paragraph.License.split('\n')[0].split(' AND ');

/** Every header of the system that a file of the product was compiled with, as the compiler told ninja. */
function headers() {
  const found = new Set();
  let ours = false;
  for (const line of output('ninja', ['-C', VRUT_BUILD, '-t', 'deps'], { maxBuffer: 1 << 30 }).split('\n')) {
    if (!line.startsWith(' ')) ours = /^(CMakeFiles|protocol|render|scenes|server|web-client)\/.*\(VALID\)/.test(line);
    else if (ours && line.startsWith('    /usr/')) found.add(path.normalize(line.trim()));
  }
  return [...found];
}

test('what is compiled in, linked or loaded is listed, and nothing else', { skip }, () => {
  const used = packagesOf([...headers(), ...linkedLibraries(VRUT_PREVIEW)]);
  // Loaded: deploy/debian/packages.cmake names them, too.
  for (const name of ['libgl1-mesa-dri', 'libavformat59', 'libavcodec59', 'libavutil57', 'libswscale6']) used.add(name);
  assert.deepEqual(listed.flatMap((paragraph) => paragraph.Package.split(' ')).sort(), [...used].sort());
});

test('each package says itself that it is under the licences that are listed', { skip }, () => {
  for (const paragraph of listed)
    for (const name of paragraph.Package.split(' ')) {
      const its = oneLine(fs.readFileSync(`/usr/share/doc/${name}/copyright`, 'utf8'));
      for (const licence of licencesOf(paragraph)) assert.ok(WORDS[licence]?.test(its), `${name}: ${licence}`);
    }
});

test('each licence that is named has its paragraph, and the project\'s is that of LICENSE', () => {
  const named = new Set(paragraphs.filter((paragraph) => paragraph.Files).flatMap(licencesOf));
  const texts = new Map(paragraphs.filter((paragraph) => paragraph.License && !paragraph.Files).map(({ License }) => License.split(/\n(.*)/s)).map(([name, text]) => [name, oneLine(text)]));
  assert.deepEqual([...texts.keys()].sort(), [...named].sort());
  assert.ok(oneLine(fs.readFileSync(path.join(DEPLOY, '../LICENSE'), 'utf8')).includes(texts.get('MIT').trim()));
});
