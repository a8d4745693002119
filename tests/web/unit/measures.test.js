import assert from 'node:assert/strict';
import { afterEach, describe, test } from 'node:test';
import { SNAPS, TOOLS, componentWords, lengthIn, measuresOf, nextPick, valueWords } from '../../../web-client/base/measures.js';
import { say, setLanguage } from '../../../web-client/base/texts.js';
import { clippedPath, middleOfPaths, seenPath } from '../../../web-client/navigation/paths.js';
import { layOut, leaderOf } from '../../../web-client/stage/chip-layout.js';
import { Latest } from '../../../web-client/stage/latest.js';
import { inLoupe, loupePlace } from '../../../web-client/stage/loupe.js';
import { SIGNS, dotData, pathData } from '../../../web-client/stage/snap-signs.js';

afterEach(() => setLanguage('en'));

describe('the picks of a tool', () => {
  const pick = (snap) => ({ node: 1, snap, points: [] });
  /** How many picks a tool takes of those that are made. */
  const taken = (kind, snaps, options) => {
    let count = 0;
    while (nextPick(kind, snaps.slice(0, count).map(pick), options)) count += 1;
    return count;
  };

  test('two for distances, one for the length of an edge', () => {
    assert.equal(taken('distance', ['vertex', 'plane']), 2);
    assert.equal(taken('parallel', ['edge', 'edge']), 2);
    assert.equal(taken('length', ['edge']), 1);
  });

  test('two directions make an angle, or three points', () => {
    for (const a of ['edge', 'plane', 'center']) {
      for (const b of ['edge', 'plane', 'center']) assert.equal(taken('angle', [a, b, 'vertex']), 2);
    }
    assert.equal(taken('angle', ['vertex', 'edge', 'edge']), 3);
    assert.equal(taken('angle', ['edge', 'midpoint', 'edge']), 3);
  });

  test('a circle has a radius by itself, or three points make one', () => {
    assert.equal(taken('radius', ['center']), 1);
    assert.deepEqual(nextPick('radius', []).to, ['center']);
    assert.equal(taken('radius', ['vertex', 'vertex', 'point'], { isByPoints: true }), 3);
    assert.ok(!nextPick('radius', [], { isByPoints: true }).to.includes('center'));
  });

  test('each says what it may be: loops are asked for alone', () => {
    assert.deepEqual(nextPick('length', [], { isLoop: true }).to, ['loop']);
    assert.deepEqual(nextPick('length', []).to, ['edge']);
    assert.deepEqual(nextPick('parallel', []).to, ['edge', 'plane', 'center']);
    assert.equal(nextPick('parallel', [pick('edge')]).to, undefined);
  });

  test('all of it has words', () => {
    for (const kind of Object.keys(TOOLS)) {
      for (const picks of [[], [pick('edge')], [pick('vertex')], [pick('vertex'), pick('vertex')]]) {
        for (const isByPoints of [false, true]) {
          const next = nextPick(kind, picks, { isByPoints });
          if (next) assert.match(say(next.ask), /^Touch .*\.$/);
        }
      }
      assert.ok(say(TOOLS[kind]));
    }
    assert.deepEqual(Object.keys(SNAPS).sort(), Object.keys(SIGNS).sort());
    for (const key of Object.values(SNAPS)) assert.ok(say(key));
  });

  test('a measure is known with what it comes to, as soon as that is told', () => {
    const measures = { a: { kind: 'length', picks: [pick('edge')] }, b: { kind: 'radius', picks: [pick('center')] } };
    const measured = { a: { value: 3, line: [] } };
    assert.deepEqual(measuresOf({ measures, measured }), { a: { ...measures.a, value: 3, line: [] }, b: measures.b });
  });
});

describe('values in words', () => {
  const mm = { metres: 0.001, shown: 'mm' };
  const words = (value, unit) => lengthIn(value, unit).replace('\u00a0', ' ');

  test('a gap to 0.01 mm, a car to 1 mm', () => {
    assert.equal(words(3.456, mm), '3.46 mm');
    assert.equal(words(99.994, mm), '99.99 mm');
    assert.equal(words(345.678, mm), '345.7 mm');
    assert.equal(words(4567.89, mm), '4,568 mm');
    assert.equal(words(0, mm), '0 mm');
    assert.equal(words(0.01234, mm), '0.01 mm');
    assert.equal(words(0.001234, mm), '0.0012 mm');
    assert.equal(words(-3.456, mm), '-3.46 mm');
  });

  test('as exactly in other units, whatever the scene\'s own', () => {
    assert.equal(words(0.003456, { metres: 1, shown: 'mm' }), '3.46 mm');
    assert.equal(words(3.456, { metres: 0.001, shown: 'cm' }), '0.346 cm');
    assert.equal(words(4567.89, { metres: 0.001, shown: 'm' }), '4.568 m');
    assert.equal(words(123456, { metres: 0.001, shown: 'm' }), '123.46 m');
    assert.equal(words(1, { metres: 0.0254, shown: 'in' }), '1 in');
    assert.equal(words(3.456, { metres: 0.001, shown: 'in' }), '0.136 in');
    assert.equal(words(4567.89, { metres: 0.001, shown: 'in' }), '179.8 in');
  });

  test('as the language writes them', async () => {
    await setLanguage('cs');
    assert.equal(lengthIn(3.456, mm), '3,46\u00a0mm');
    assert.equal(valueWords({ kind: 'angle', picks: [], value: 12.345 }, mm), '12,3°');
  });

  test('angles have degrees, and what has no value has no words', () => {
    assert.equal(valueWords({ kind: 'angle', picks: [], value: 90 }, mm), '90°');
    assert.equal(valueWords({ kind: 'radius', picks: [], value: 12.5 }, mm), '12.5\u00a0mm');
    assert.equal(valueWords({ kind: 'radius', picks: [], problem: 'no' }, mm), '');
  });

  test('a distance along the axes', () => {
    assert.deepEqual(componentWords({ kind: 'distance', picks: [], value: 2.69, components: [1, -2.5, -0] }, mm),
      { x: '1\u00a0mm', y: '-2.5\u00a0mm', z: '0\u00a0mm' });
    // As exactly as the distance itself.
    assert.deepEqual(componentWords({ kind: 'distance', picks: [], value: 530.09, components: [530, 0.0015, -0.0002] }, mm),
      { x: '530\u00a0mm', y: '0\u00a0mm', z: '0\u00a0mm' });
    assert.equal(componentWords({ kind: 'radius', picks: [] }, mm), null);
  });
});

describe('lines as they are seen', () => {
  const camera = { eye: [0, 0, 10], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0], fov: 90 };
  const lens = { camera, width: 200, height: 100 };
  const rounded = (pieces) => pieces.map((piece) => piece.map(({ x, y }) => [Math.round(x) + 0, Math.round(y) + 0]));

  test('in one piece where all of it is before the eye', () => {
    assert.deepEqual(rounded(seenPath(lens, [[0, 0, 0], [10, 0, 0], [10, 10, 0]])), [[[100, 50], [150, 50], [150, 0]]]);
  });

  test('what is behind the eye is left out', () => {
    assert.deepEqual(seenPath(lens, [[0, 0, 20], [5, 0, 30]]), []);
    const [piece, ...others] = seenPath(lens, [[0, 0, 0], [0, -1, 20], [0, -1, 30]]);
    assert.deepEqual(others, []);
    assert.deepEqual(rounded([[piece[0]]]), [[[100, 50]]]);
    assert.ok(piece[1].y > 1e5 && Math.abs(piece[1].x - 100) < 1);
    assert.equal(seenPath(lens, [[0, 0, 0], [0, 0, 20], [1, 0, 0]]).length, 2);
  });

  test('and what is outside of an area', () => {
    const area = { left: 0, top: 0, right: 100, bottom: 50 };
    const clipped = (...line) => rounded(clippedPath(line.map(([x, y]) => ({ x, y })), area));
    assert.deepEqual(clipped([-50, 25], [150, 25]), [[[0, 25], [100, 25]]]);
    assert.deepEqual(clipped([10, 10], [20, 20], [30, 10]), [[[10, 10], [20, 20], [30, 10]]]);
    assert.deepEqual(clipped([10, 10], [10, 90], [20, 90], [20, 10]), [[[10, 10], [10, 50]], [[20, 50], [20, 10]]]);
    assert.deepEqual(clipped([-10, -10], [-10, 90]), []);
    assert.deepEqual(clipped([-10, 10], [10, -15]), []);
    assert.deepEqual(clipped([5, 5], [5, 5]), [[[5, 5], [5, 5]]]);
  });

  test('the middle is that of the longest piece', () => {
    const line = (...places) => places.map(([x, y]) => ({ x, y }));
    assert.deepEqual(middleOfPaths([line([0, 0], [1, 0]), line([0, 0], [10, 0], [10, 10])]), { x: 10, y: 0 });
    assert.deepEqual(middleOfPaths([line([0, 0], [30, 0], [30, 10])]), { x: 20, y: 0 });
    assert.deepEqual(middleOfPaths([line([3, 4], [3, 4])]), { x: 3, y: 4 });
    assert.equal(middleOfPaths([]), null);
  });

  test('as SVG', () => {
    assert.equal(pathData([[{ x: 1, y: 2 }, { x: 3.04, y: 4 }], [{ x: 0, y: 0 }]]), 'M1.0 2.0L3.0 4.0M0.0 0.0');
    assert.equal(dotData([{ x: 1, y: 2 }]), 'M1.0 2.0h0');
  });
});

describe('the layout of chips', () => {
  const area = { left: 0, top: 0, right: 1000, bottom: 800 };
  const chip = (name, x, y, width = 80, height = 28) => ({ name, at: { x, y }, width, height });
  const slotsOf = (laid) => new Map(laid.map(({ name, slot }) => [name, slot]));
  const boxes = (laid, wanted) => laid.map(({ name, x, y }) => {
    const { width, height } = wanted.find((one) => one.name === name);
    return { left: x - width / 2, right: x + width / 2, top: y - height / 2, bottom: y + height / 2 };
  });
  const checkApart = (all, within) => {
    for (const [i, a] of all.entries()) {
      assert.ok(a.left >= within.left && a.right <= within.right && a.top >= within.top && a.bottom <= within.bottom);
      for (const b of all.slice(0, i)) {
        assert.ok(a.left >= b.right || b.left >= a.right || a.top >= b.bottom || b.top >= a.bottom);
      }
    }
  };

  test('one by itself lies where it is wanted, without a leader', () => {
    const [laid] = layOut([chip('a', 300, 200)], area, new Map());
    assert.deepEqual(laid, { name: 'a', at: { x: 300, y: 200 }, x: 300, y: 200, slot: 0 });
    assert.deepEqual(leaderOf(laid, { width: 80, height: 28 }), []);
  });

  test('none covers another, and who is elsewhere has a leader from its edge', () => {
    const wanted = Array.from({ length: 20 }, (_, i) => chip(`m${i}`, 500 + i, 400 + i, 60 + 5 * i));
    const laid = layOut(wanted, area, new Map());
    assert.equal(laid.length, 20);
    checkApart(boxes(laid, wanted), area);
    const second = laid.find(({ name }) => name === 'm1');
    const [[from, to]] = leaderOf(second, wanted[1]);
    assert.deepEqual(to, wanted[1].at);
    assert.ok(Math.abs(Math.abs(from.y - second.y) - 14) < 1e-9 || Math.abs(Math.abs(from.x - second.x) - wanted[1].width / 2) < 1e-9);
  });

  test('all 256 of one place: those that have room', () => {
    const wanted = Array.from({ length: 256 }, (_, i) => chip(`m${i}`, 500, 400));
    const laid = layOut(wanted, area, new Map());
    assert.ok(laid.length >= 30 && laid.length < 256);
    checkApart(boxes(laid, wanted), area);
  });

  test('one that would hide what it tells of lies beside that, also if it did not before', () => {
    for (const before of [new Map(), new Map([['a', 0]])]) {
      const [laid] = layOut([{ ...chip('a', 300, 200), isBeside: true }], area, before);
      assert.ok(laid.slot > 0 && laid.y <= 200 - 28);
    }
    const [kept] = layOut([chip('a', 300, 200)], area, new Map([['a', 3]]));
    assert.equal(kept.slot, 3);
  });

  test('at the edges they are moved inwards', () => {
    const wanted = [chip('a', 1, 1), chip('b', 999, 799), chip('c', 990, 790)];
    const laid = layOut(wanted, area, new Map());
    assert.equal(laid.length, 3);
    checkApart(boxes(laid, wanted), area);
    assert.deepEqual(layOut([chip('wide', 500, 400, 1200)], area, new Map()), []);
  });

  test('who has a place keeps it while that is free, whoever comes before it', () => {
    const first = layOut([chip('a', 500, 400), chip('b', 505, 402)], area, new Map());
    assert.deepEqual(first.map(({ slot }) => slot > 0), [false, true]);
    const slots = slotsOf(first);
    // They are farther from each other now: no number jumps for that.
    const moved = layOut([chip('a', 480, 400), chip('b', 600, 402)], area, slots);
    assert.deepEqual(slotsOf(moved), slots);
    const joined = layOut([chip('0', 480, 400), chip('a', 480, 400), chip('b', 600, 402)], area, slots);
    for (const name of ['a', 'b']) assert.equal(slotsOf(joined).get(name), slots.get(name));
    assert.ok(slotsOf(joined).get('0') > 0);
    // Where two that have a place come together, the first of them keeps it.
    const met = layOut([chip('a', 500, 400), chip('b', 500, 400)], area, new Map([['a', 0], ['b', 0]]));
    assert.deepEqual(met.map(({ slot }) => slot > 0), [false, true]);
  });
});

describe('the loupe', () => {
  const area = { left: 0, top: 0, right: 400, bottom: 800 };
  const reach = 60;

  test('lies above the finger, and never under it or outside', () => {
    assert.deepEqual(loupePlace({ x: 200, y: 500 }, area), { x: 200, y: 392 });
    assert.deepEqual(loupePlace({ x: 10, y: 500 }, area), { x: 60, y: 392 });
    assert.deepEqual(loupePlace({ x: 395, y: 500 }, area), { x: 340, y: 392 });
    for (let x = 0; x <= 400; x += 10) {
      for (let y = 0; y <= 800; y += 10) {
        const place = loupePlace({ x, y }, area);
        assert.ok(place.x >= reach && place.x <= 400 - reach && place.y >= reach && place.y <= 800 - reach);
        assert.ok(Math.hypot(place.x - x, place.y - y) > reach + 15, `${x}, ${y}`);
      }
    }
  });

  test('at the upper edge it goes aside, to the left where that has room', () => {
    assert.deepEqual(loupePlace({ x: 300, y: 40 }, area), { x: 192, y: 60 });
    assert.deepEqual(loupePlace({ x: 50, y: 100 }, area), { x: 158, y: 100 });
  });

  test('it shows three times as large what is around the finger', () => {
    assert.deepEqual(inLoupe({ x: 100, y: 100 }, { x: 100, y: 100 }), { x: 60, y: 60 });
    assert.deepEqual(inLoupe({ x: 110, y: 95 }, { x: 100, y: 100 }), { x: 90, y: 45 });
  });
});

describe('questions of which the newest counts', () => {
  /** Answers what is asked when it is told to. */
  function asker() {
    const asked = [];
    const answered = [];
    const latest = new Latest((question) => new Promise((resolve) => {
      asked.push({ question, answer: () => resolve(`of ${question.name}`) });
    }), () => answered.push(latest.last.answer));
    const next = async () => {
      asked.shift().answer();
      await new Promise(setImmediate);
    };
    return { latest, asked, answered, next, names: () => asked.map(({ question }) => question.name) };
  }
  const [a, b, c] = ['a', 'b', 'c'].map((name) => ({ name }));

  test('one at a time, and the last of those that came meanwhile', async () => {
    const { latest, answered, next, names } = asker();
    for (const question of [a, b, c]) latest.want(question);
    assert.deepEqual(names(), ['a']);
    await next();
    assert.deepEqual(names(), ['c']);
    await next();
    assert.deepEqual([names(), answered], [[], ['of a', 'of c']]);
  });

  test('the answer to the last is waited for, and not asked for twice', async () => {
    const { latest, next, names } = asker();
    latest.want(a);
    const answer = latest.answerTo(b);
    await next();
    await next();
    assert.equal(await answer, 'of b');
    assert.equal(await latest.answerTo(b), 'of b');
    assert.deepEqual(names(), []);
  });

  test('what was forgotten is not told', async () => {
    const { latest, answered, next, names } = asker();
    latest.want(a);
    const answer = latest.answerTo(b);
    latest.forget();
    await next();
    assert.deepEqual([await answer, answered, latest.last, names()], [undefined, [], null, []]);
    latest.want(c);
    await next();
    assert.deepEqual(answered, ['of c']);
  });
});
