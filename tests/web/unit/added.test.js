import assert from 'node:assert/strict';
import { afterEach, describe, test } from 'node:test';
import { added, deletionOf, isNone, restorationOf } from '../../../web-client/base/added.js';
import { mergePatch } from '../../../web-client/base/merge-patch.js';
import { setLanguage } from '../../../web-client/base/texts.js';
import { countWords } from '../../../web-client/panels/dialogs/deletion.js';

const NONE = { cues: {}, markers: {}, measures: {}, views: {} };
const FULL = {
  cues: { Arrival: { ms: 5 } }, markers: { 'note 1': { text: 'Gap' } }, measures: { Wide: { kind: 'angle' } },
  views: { home: { fov: 40 }, Left: { order: 0 } }, nodes: { 1: { active: false } }, unit: { metres: 1, shown: 'cm' },
};
const some = (counts) => Object.fromEntries(Object.entries({ ...NONE, ...counts })
  .map(([member, count]) => [member, Object.fromEntries(Array.from({ length: Number(count) || 0 }, (_, i) => [`${i}`, {}]))]));

afterEach(() => setLanguage('en'));

describe('what people have added to a scene', () => {
  test('is cues, notes, measures and saved views', () => {
    const { nodes, unit, views: { home, ...views }, ...others } = FULL;
    assert.deepEqual(added(FULL), { ...others, views });
    assert.equal(isNone(added(FULL)), false);
    assert.equal(isNone(added({ ...FULL, ...NONE, views: { home } })), true);
    for (const member of Object.keys(NONE)) assert.equal(isNone({ ...NONE, [member]: { a: {} } }), false, member);
  });

  test('is deleted, and nothing else: doors, paint, parts and the unit of lengths stay', () => {
    const { nodes, unit, views: { home } } = FULL;
    assert.deepEqual(mergePatch(FULL, deletionOf(added(FULL))), { ...NONE, views: { home }, nodes, unit });
  });

  test('what has come since the question stays', () => {
    const all = added(FULL);
    const later = mergePatch(FULL, { markers: { 'note 2': { text: 'Dent' } } });
    assert.deepEqual(mergePatch(later, deletionOf(all)).markers, { 'note 2': { text: 'Dent' } });
  });

  test('comes back as it was', () => {
    const all = added(FULL);
    const now = mergePatch(FULL, deletionOf(all));
    assert.deepEqual(restorationOf(all, now).markers, { 'note 1': { author: null, view: null, text: 'Gap' } });
    assert.deepEqual(mergePatch(now, restorationOf(all, now)), FULL);
  });

  test('comes back beside what has come since, under another name where that is taken', () => {
    const all = { ...NONE, views: { A: { fov: 1 }, 'A 1': { fov: 2 }, B: { fov: 3 } }, cues: { A: { ms: 1 } } };
    const now = { ...NONE, views: { home: {}, A: { fov: 9 } }, cues: { B: { ms: 2 } } };
    assert.deepEqual(mergePatch(now, restorationOf(all, now)), {
      ...NONE, views: { home: {}, A: { fov: 9 }, 'A 2': { fov: 1 }, 'A 1': { fov: 2 }, B: { fov: 3 } }, cues: { A: { ms: 1 }, B: { ms: 2 } },
    });
  });

  test('is counted in words', async () => {
    const words = () => [
      { cues: 5, markers: 2, measures: 3, views: 4 }, { cues: 1, markers: 1, measures: 1, views: 1 }, { markers: 5, views: 12 }, { cues: 2 },
    ].map((counts) => countWords(some(counts)).replaceAll('\u00a0', ' ')); // also behind "a", in some browsers
    assert.deepEqual(words(), [
      '5 cues, 2 notes, 3 measures and 4 views', '1 cue, 1 note, 1 measure and 1 view', '5 notes and 12 views', '2 cues',
    ]);
    await setLanguage('cs');
    assert.deepEqual(words(), [
      '5 záběrů, 2 poznámky, 3 měření a 4 pohledy', '1 záběr, 1 poznámku, 1 měření a 1 pohled', '5 poznámek a 12 pohledů', '2 záběry',
    ]);
  });
});
