// CHANGELOG.md: a section for each version, the newest first, which is the one that is built.
'use strict';
const assert = require('node:assert/strict');
const fs = require('node:fs');
const path = require('node:path');
const { test } = require('node:test');
const { DEPLOY } = require('./helpers.js');

const { VRUT_BUILD } = process.env;
const SECTIONS = ['To do when you update', 'Added', 'Changed', 'Fixed', 'Removed'];
const text = fs.readFileSync(path.join(DEPLOY, '../CHANGELOG.md'), 'utf8');

test('the newest version is the one that is built', () => {
  const built = /^CMAKE_PROJECT_VERSION:\w+=(.*)$/m.exec(fs.readFileSync(path.join(VRUT_BUILD, 'CMakeCache.txt'), 'utf8'))[1];
  const versions = [...text.matchAll(/^## (.*)$/gm)].map(([, title]) => title);
  assert.equal(versions[0], built);
  for (const version of versions) assert.match(version, /^\d+\.\d+\.\d+$/);
  const order = versions.map((version) => version.split('.').reduce((sum, part) => sum * 1000 + Number(part), 0));
  for (let i = 1; i < order.length; i++) assert.ok(order[i] < order[i - 1], `${versions}`);
});

test('every change stands in a section that says what kind it is', () => {
  for (const part of text.split(/^## .*$/m).slice(1)) {
    const [lead, ...sections] = part.split(/^### /m);
    assert.doesNotMatch(lead, /^- /m);
    const titles = sections.map((section) => section.split('\n')[0]);
    assert.deepEqual(titles, SECTIONS.filter((title) => titles.includes(title)));
    assert.ok(titles.length > 0);
    for (const section of sections) assert.match(section, /^- /m);
  }
});
