// Contract: NAVIGATION.md: every row of its table with its numbers. The view is 400 x 300, its shorter side 300.
import assert from 'node:assert/strict';
import { after, describe, test } from 'node:test';
import { add, axes, dot, length, near, nearCamera, pixelAtFocus, projected, scale, sub, turnedAbout, unit } from './numbers.js';
import { schemaTest } from './schema.js';
import { Server } from './server.js';
import { POSE, SEEN, steering, VIEW } from './stage.js';

const server = await Server.start();
after(() => server.stop());

const [LEFT, MIDDLE, RIGHT] = [0, 1, 2];
const Y = [0, 1, 0];
const MIDDLE_OF_VIEW = [VIEW.width / 2, VIEW.height / 2];
const ASKEW = { eye: [3, 2, 7], focus: [0.5, 0.25, -0.5], center: [-1, 0.5, 1] };
const ALIKE = ['eye', 'focus', 'up', 'center', 'fov'];
const pose = (camera) => Object.fromEntries(ALIKE.map((member) => [member, camera[member]]));
const distance = ({ eye, focus }) => length(sub(focus, eye));

/** The pose turned as by a drag of `right` and `down` degrees with keepUpright: first tipped, then turned. */
function orbited(camera, right, down) {
  const side = axes(camera).right;
  const both = (point, center) => turnedAbout(turnedAbout(point, center, side, -down), center, Y, -right);
  return { eye: both(camera.eye, camera.center), focus: both(camera.focus, camera.center), up: both(camera.up, [0, 0, 0]), center: camera.center };
}

/** The nearest point of a surface that is seen at a place, or else the one at focus depth there. */
async function touched(client, [x, y]) {
  const { node, point } = await client.ask({ type: 'pick', x, y });
  if (node !== undefined) return point;
  const { camera } = client.state;
  const { right, up } = axes(camera);
  const pixel = pixelAtFocus(camera, VIEW);
  const aside = add(scale(right, (x - VIEW.width / 2) * pixel), scale(up, (VIEW.height / 2 - y) * pixel));
  return add(camera.focus, aside);
}

/** Panned so that what is as deep as `point` moves by CSS pixels right and down. */
function panned(camera, right, down, point = camera.focus) {
  const a = axes(camera);
  const depth = dot(sub(point, camera.eye), a.view);
  const pixel = pixelAtFocus(camera, VIEW) * (depth / distance(camera));
  const shift = add(scale(a.right, -right * pixel), scale(a.up, down * pixel));
  return { eye: add(camera.eye, shift), focus: add(camera.focus, shift), up: camera.up, fov: camera.fov };
}

/** Eye and focus nearer to `point` by `factor`. */
const zoomed = (camera, factor, point = camera.focus) => ({
  eye: add(point, scale(sub(camera.eye, point), 1 / factor)),
  focus: add(point, scale(sub(camera.focus, point), 1 / factor)),
  up: camera.up,
});

/** Where a part is seen, nearer than the focus or farther, and where nothing is. */
const PLACES = [SEEN.door, SEEN.pane, SEEN.wall, SEEN.nothing];

const DRAGGED = [[50, 150], [90, 150], [125, 150]]; // 75 pixels: 45 degrees

describe('rotate: left drag, one finger', () => {
  for (const [pointer, more] of [['left drag', {}], ['one finger', { pointerType: 'touch' }], ['pen', { pointerType: 'pen' }]]) {
    test(`${pointer}: the shorter side is 180 degrees, right turns the scene right, down tips its top nearer`, async (t) => {
      const client = await steering(t, server);
      await client.input.drag(DRAGGED, LEFT, more);
      const s = 8 * Math.SQRT1_2;
      nearCamera(client.state.camera, { eye: [-s, 0, s], focus: [0, 0, 0], up: [0, 1, 0], center: [0, 0, 0] }, 'right');
      await client.patch({ camera: POSE });
      await client.input.drag([[200, 100], [200, 150]], LEFT, more);
      nearCamera(client.state.camera, { eye: [0, 4, 8 * Math.sqrt(0.75)], focus: [0, 0, 0], up: [0, Math.sqrt(0.75), -0.5] }, 'down 30');
    });
  }

  for (const keepUpright of [true, false]) {
    test(`around center, whose distances stay; keepUpright ${keepUpright}`, async (t) => {
      const client = await steering(t, server, ASKEW);
      await client.patch({ navigation: { keepUpright } });
      const before = client.state.camera;
      await client.input.drag([[50, 150], [140, 150]]); // 54 degrees
      const { camera } = client.state;
      const axis = keepUpright ? Y : before.up;
      const turn = (point, center) => turnedAbout(point, center, axis, -54);
      nearCamera(camera, { eye: turn(before.eye, before.center), focus: turn(before.focus, before.center), up: turn(before.up, [0, 0, 0]), center: before.center }, 'right');
      for (const member of ['eye', 'focus']) near(length(sub(camera[member], camera.center)), length(sub(before[member], before.center)), `${member} to center`);
    });

    test(`down, about the camera's right through center; keepUpright ${keepUpright}`, async (t) => {
      const client = await steering(t, server, ASKEW);
      await client.patch({ navigation: { keepUpright } });
      const before = client.state.camera;
      await client.input.drag([[200, 150], [200, 175]]); // 15 degrees
      const turn = (point, center) => turnedAbout(point, center, axes(before).right, -15);
      nearCamera(client.state.camera, { eye: turn(before.eye, before.center), focus: turn(before.focus, before.center), up: turn(before.up, [0, 0, 0]) }, 'down');
    });
  }

  test('in both directions at once', async (t) => {
    const client = await steering(t, server, ASKEW);
    await client.patch({ navigation: { keepUpright: true } });
    const before = client.state.camera;
    await client.input.drag([[50, 150], [100, 160], [150, 170]]); // 60 and 12 degrees
    nearCamera(client.state.camera, orbited(before, 60, 12), 'both');
  });

  test('with keepUpright it never stands on its head', async (t) => {
    const client = await steering(t, server);
    await client.patch({ navigation: { keepUpright: true } });
    for (const y of [299, 1]) {
      await client.input.drag([[200, 150], [200, y]]);
      await client.input.drag([[200, 150], [200, y]]);
      assert.ok(client.state.camera.up[1] > -1e-9, `${client.state.camera.up}`);
    }
  });

  test('with turnAbout touched, about what was touched, and else about center, which stays', async (t) => {
    const client = await steering(t, server);
    await client.patch({ navigation: { turnAbout: 'touched' } });
    for (const place of PLACES) {
      await client.patch({ camera: { ...POSE, center: [1, 2, 3] } });
      const before = client.state.camera;
      const { node, point } = await client.ask({ type: 'pick', x: place[0], y: place[1] });
      await client.input.drag([place, add(place, [75, 25])]); // 45 and 15 degrees
      const about = node === undefined ? before.center : point;
      nearCamera(client.state.camera, { ...orbited({ ...before, center: about }, 45, 15), center: before.center }, 'turn');
    }
    await client.patch({ navigation: null });
  });

  test('goes on outside of the view', async (t) => {
    const client = await steering(t, server);
    await client.input.drag([[390, 150], [690, 150]]);
    nearCamera(client.state.camera, { eye: [0, 0, -8], up: [0, 1, 0] }, '180 degrees');
  });

  test('is a function of where the pointer is, not of how it came there', async (t) => {
    const client = await steering(t, server, ASKEW);
    const ends = [];
    const detour = Array.from({ length: 60 }, (_, i) => [200 + 150 * Math.sin(i), 150 + 140 * Math.cos(2 * i)]);
    for (const between of [[], [[100, 100], [150, 120]], detour]) {
      await client.patch({ camera: { ...POSE, ...ASKEW } });
      await client.input.drag([[60, 60], ...between, [170.25, 91.5]]);
      ends.push(pose(client.state.camera));
    }
    assert.deepEqual(ends[1], ends[0]);
    assert.deepEqual(ends[2], ends[0]);
  });

  test('rotateSpeed 2 turns twice as far', async (t) => {
    const client = await steering(t, server);
    await client.patch({ navigation: { rotateSpeed: 2 } });
    await client.input.drag(DRAGGED);
    nearCamera(client.state.camera, { eye: [-8, 0, 0] }, '90 degrees');
    await client.patch({ navigation: null });
  });
});

describe('pan: right drag, two fingers', () => {
  test('right drag: what was touched stays under the finger', async (t) => {
    const client = await steering(t, server);
    for (const from of PLACES) {
      await client.patch({ camera: POSE });
      const before = client.state.camera;
      const point = await touched(client, from);
      const to = add(from, [125, 111]);
      near(projected(before, VIEW, point), from, 'where it begins');
      await client.input.drag([from, [300, 20], to], RIGHT);
      near(projected(client.state.camera, VIEW, point), to, 'where it ends');
      nearCamera(client.state.camera, panned(before, 125, 111, point), 'pan');
    }
  });

  test('two fingers, by the point between them', async (t) => {
    const client = await steering(t, server);
    for (const middle of PLACES) {
      await client.patch({ camera: POSE });
      const before = client.state.camera;
      const point = await touched(client, middle);
      const pair = (place) => [add(place, [-50, 0]), add(place, [50, 0])];
      await fingers(client, pair(middle), pair(add(middle, [30, -10])));
      nearCamera(client.state.camera, panned(before, 30, -10, point), 'pan');
    }
  });

  test('panSpeed 2 moves twice as far', async (t) => {
    const client = await steering(t, server);
    const before = client.state.camera;
    await client.patch({ navigation: { panSpeed: 2 } });
    const point = await touched(client, [100, 100]);
    await client.input.drag([[100, 100], [150, 120]], RIGHT);
    nearCamera(client.state.camera, panned(before, 100, 40, point), 'pan');
    await client.patch({ navigation: null });
  });
});

/** Two fingers go down at `from`, to `to` and up. */
async function fingers(client, from, to) {
  const { input } = client;
  for (const i of [0, 1]) input.down(from[i], LEFT, input.finger(10 + i));
  await input.pass(20);
  for (const i of [0, 1]) input.move(to[i], LEFT, input.finger(10 + i));
  for (const i of [0, 1]) input.up(to[i], LEFT, input.finger(10 + i));
  await client.barrier();
}

describe('zoom: wheel, middle drag, pinch and spread', () => {
  for (const [deltaY, deltaMode, factor] of [
    [-100, 0, 1.1], [-3, 1, 1.1], [-1 / 3, 2, 1.1], [100, 0, 1 / 1.1], [3, 1, 1 / 1.1], [1 / 3, 2, 1 / 1.1], [-300, 0, 1.1 ** 3], [-50, 0, Math.sqrt(1.1)],
  ]) {
    test(`wheel by ${deltaY.toFixed(2)} in mode ${deltaMode} divides the distance by ${factor.toFixed(3)}`, async (t) => {
      const client = await steering(t, server, ASKEW);
      const before = client.state.camera;
      const point = await touched(client, MIDDLE_OF_VIEW);
      await client.input.wheel(deltaY, deltaMode);
      nearCamera(client.state.camera, { ...zoomed(before, factor, point), center: before.center, fov: before.fov }, 'zoom');
    });
  }

  test('the wheel keeps what lies under the pointer where it is seen', async (t) => {
    const client = await steering(t, server);
    for (const place of PLACES) {
      await client.patch({ camera: POSE });
      const before = client.state.camera;
      const point = await touched(client, place);
      await client.input.wheel(-300, 0, place);
      nearCamera(client.state.camera, zoomed(before, 1.1 ** 3, point), 'zoom');
      near(projected(client.state.camera, VIEW, point), place, 'where it is seen');
    }
  });

  test('middle drag up over the height divides it by 4, halfway by 2, down multiplies', async (t) => {
    const client = await steering(t, server, ASKEW);
    const before = client.state.camera;
    for (const [points, factor] of [[[[200, 300], [200, 0]], 4], [[[200, 250], [230, 100]], 2], [[[200, 0], [200, 10], [200, 300]], 1 / 4]]) {
      await client.patch({ camera: { ...POSE, ...ASKEW } });
      await client.input.drag(points, MIDDLE);
      nearCamera(client.state.camera, zoomed(before, factor), `a middle drag for ${factor}`);
    }
  });

  test('a pinch divides it by the ratio of the distances of the fingers', async (t) => {
    const client = await steering(t, server, ASKEW);
    const before = client.state.camera;
    const point = await touched(client, MIDDLE_OF_VIEW);
    await fingers(client, [[150, 150], [250, 150]], [[100, 150], [300, 150]]);
    nearCamera(client.state.camera, zoomed(before, 2, point), 'spread');
    await client.patch({ camera: { ...POSE, ...ASKEW } });
    await fingers(client, [[140, 110], [260, 190]], [[185, 140], [215, 160]]);
    nearCamera(client.state.camera, zoomed(before, 1 / 4, point), 'pinch');
  });

  test('together with the pan: what was between the fingers still is', async (t) => {
    const client = await steering(t, server);
    for (const [x, y] of PLACES) {
      await client.patch({ camera: POSE });
      const before = client.state.camera;
      const point = await touched(client, [x, y]);
      await fingers(client, [[x - 50, y], [x + 50, y]], [[x - 40, y - 20], [x + 160, y - 20]]);
      near(distance(client.state.camera), distance(before) / 2, 'distance');
      near(projected(client.state.camera, VIEW, point), [x + 60, y - 20], 'the point that was between them');
      near(axes(client.state.camera).view, axes(before).view, 'the direction');
    }
  });

  test('zoomSpeed 2 squares the factor', async (t) => {
    const client = await steering(t, server);
    await client.patch({ navigation: { zoomSpeed: 2 } });
    await client.input.wheel(-100);
    near(distance(client.state.camera), 8 / 1.21, 'distance');
    await client.patch({ navigation: null });
  });
});

describe('select: left double click, double tap', () => {
  const TOUCH = { pointerType: 'touch' };
  const HINGE = 3; // of the door
  for (const [what, more] of [['left double click', {}], ['double tap', TOUCH]]) {
    test(`${what} selects what is there, on nothing clears the selection`, async (t) => {
      const client = await steering(t, server);
      const { camera } = client.state;
      await client.input.doubleClick(SEEN.door, LEFT, more);
      assert.equal(client.state.selection.node, HINGE, 'the part that a person would name');
      assert.deepEqual(client.state.selection.pathIds, [0, 1, HINGE]);
      await client.input.doubleClick(SEEN.door, LEFT, more);
      assert.equal(client.state.selection.node, 4, 'a level deeper');
      await client.input.doubleClick(SEEN.wall, LEFT, more);
      assert.equal(client.state.selection.node, 2);
      await client.input.doubleClick(SEEN.nothing, LEFT, more);
      assert.deepEqual(client.state.selection, {});
      assert.deepEqual(pose(client.state.camera), pose(camera), 'the camera stays');
    });
  }

  /** Presses of the left button: [down at ms, where, up at ms, where]. */
  async function presses(client, list) {
    const { input } = client;
    let now = 0;
    for (const [down, from, up, to = from] of list) {
      await input.pass(down - now);
      input.down(from);
      await input.pass(up - down);
      input.up(to);
      now = up;
    }
    await client.barrier();
  }
  const [X, Y0] = SEEN.door;
  const D = [X, Y0];
  const CASES = [
    ['one click', [[0, D, 20]], false],
    ['a press just within 250 ms', [[0, D, 240], [260, D, 280]], true],
    ['a first press longer than 250 ms', [[0, D, 270], [300, D, 320]], false],
    ['a second press longer than 250 ms', [[0, D, 20], [100, D, 370]], false],
    ['the second press just within 400 ms of the first', [[0, D, 20], [390, D, 410]], true],
    ['the second press after 400 ms', [[0, D, 20], [415, D, 435]], false],
    ['up within 10 pixels', [[0, D, 20, [X + 9, Y0]], [60, D, 80, D]], true],
    ['up beyond 10 pixels', [[0, D, 20, [X + 11, Y0]], [60, D, 80, D]], false],
    ['the second press within 24 pixels', [[0, [X - 23, Y0], 20], [60, D, 80]], true],
    ['the second press beyond 24 pixels', [[0, [X - 25, Y0], 20], [60, D, 80]], false],
  ];
  for (const [what, list, selects] of CASES) {
    test(`${what}: ${selects ? 'a double click' : 'none'}`, async (t) => {
      const client = await steering(t, server);
      await presses(client, list);
      assert.equal(client.state.selection.node, selects ? HINGE : undefined);
    });
  }

  test('two clicks of different buttons are none', async (t) => {
    const client = await steering(t, server);
    await client.input.click(D, RIGHT);
    await client.input.click(D, LEFT);
    await client.barrier();
    assert.equal(client.state.selection.node, undefined);
    assert.deepEqual(client.state.camera.center, [0, 0, 0]);
  });

  test('two taps of different clients are none', async (t) => {
    const client = await steering(t, server);
    await client.input.click(D);
    const other = await steering(t, server);
    await other.input.click(D);
    await other.barrier();
    assert.equal(other.state.selection.node, undefined);
  });

  for (const [what, times] of [['absent', [undefined, undefined, undefined, undefined]], ['falling', [500, 480, 300, 100]], ['more than 1 s off', [0, 5000, 10000, 15000]]]) {
    test(`where timeStamp is ${what}, arrival counts`, async (t) => {
      const client = await steering(t, server);
      const [x, y] = D;
      times.forEach((timeStamp, i) => {
        const isDown = i % 2 === 0;
        const event = { type: isDown ? 'pointerdown' : 'pointerup', pointerId: 1, pointerType: 'mouse', x, y, button: 0, buttons: isDown ? 1 : 0 };
        client.send(timeStamp === undefined ? event : { ...event, timeStamp });
      });
      await client.barrier();
      assert.equal(client.state.selection.node, HINGE);
    });
  }

  test('timeStamp counts where arrivals lie: two clicks that came together, but are 600 ms apart', async (t) => {
    const client = await steering(t, server);
    const [x, y] = D;
    for (const [type, timeStamp] of [['pointerdown', 1000], ['pointerup', 1020], ['pointerdown', 1600], ['pointerup', 1620]]) {
      client.send({ type, pointerId: 1, pointerType: 'mouse', x, y, button: 0, buttons: type === 'pointerdown' ? 1 : 0, timeStamp });
    }
    await client.barrier();
    assert.equal(client.state.selection.node, undefined);
  });

  test('what is clicked is what the user saw in `frame`', async (t) => {
    const client = await steering(t, server);
    const seen = (await client.frameOfNow()).header.frame;
    await client.ask({ type: 'navigate', rotate: [90, 0] });
    await client.frameOfNow();
    await client.input.doubleClick(SEEN.door, LEFT, { frame: seen });
    assert.equal(client.state.selection.node, HINGE);
  });
});

describe('set center', () => {
  // SEEN.door is 56 pixels right of the middle, at the focus' depth.
  const POINT = [56 * pixelAtFocus(POSE, VIEW), 0, 0];

  test('right double click: center, and nothing else', async (t) => {
    const client = await steering(t, server);
    await client.input.doubleClick(SEEN.door, RIGHT);
    nearCamera(client.state.camera, { ...POSE, center: POINT }, 'center');
    assert.equal(client.state.selection.node, undefined);
    const before = pose(client.state.camera);
    await client.input.doubleClick(SEEN.nothing, RIGHT);
    assert.deepEqual(pose(client.state.camera), before, 'on nothing');
  });

  test('middle double click: center, and eye and focus move together to look at it', async (t) => {
    const client = await steering(t, server);
    await client.input.doubleClick(SEEN.door, MIDDLE);
    nearCamera(client.state.camera, { ...POSE, center: POINT, focus: POINT, eye: add(POSE.eye, POINT) }, 'look at');
    const before = pose(client.state.camera);
    await client.input.doubleClick(SEEN.nothing, MIDDLE);
    assert.deepEqual(pose(client.state.camera), before, 'on nothing');
  });

  test('one finger rests, a second taps: its point', async (t) => {
    const client = await steering(t, server);
    const { input } = client;
    const tap = async (at) => {
      input.down([150, 250], LEFT, input.finger(20));
      await input.pass(350);
      input.down(at, LEFT, input.finger(21));
      await input.pass(60);
      input.up(at, LEFT, input.finger(21));
      await input.pass(100);
      input.up([150, 250], LEFT, input.finger(20));
      await client.barrier();
    };
    await tap(SEEN.door);
    nearCamera(client.state.camera, { ...POSE, center: POINT, focus: POINT, eye: add(POSE.eye, POINT) }, 'press and tap');
    assert.equal(client.state.selection.node, undefined);
    const before = pose(client.state.camera);
    await tap(SEEN.nothing);
    assert.deepEqual(pose(client.state.camera), before, 'on nothing');
  });

  test('a second finger that stays is a pinch, not a tap', async (t) => {
    const client = await steering(t, server);
    const { input } = client;
    input.down([150, 250], LEFT, input.finger(20));
    await input.pass(350);
    input.down(SEEN.door, LEFT, input.finger(21));
    await input.pass(300);
    input.up(SEEN.door, LEFT, input.finger(21));
    input.up([150, 250], LEFT, input.finger(20));
    await client.barrier();
    assert.deepEqual(client.state.camera.center, [0, 0, 0]);
  });
});

describe('pointers', () => {
  test('pointercancel ends a drag and keeps the camera', async (t) => {
    const client = await steering(t, server);
    const { input } = client;
    input.down([50, 150]);
    input.move([125, 150]);
    input.pointer('pointercancel', [125, 150]);
    await client.barrier();
    const { camera } = client.state;
    near(camera.eye, [-8 * Math.SQRT1_2, 0, 8 * Math.SQRT1_2], 'eye');
    input.move([200, 150]);
    await client.barrier();
    assert.deepEqual(client.state.camera, camera);
  });

  test('a second pointerdown of a pressed one starts anew', async (t) => {
    const client = await steering(t, server);
    const { input } = client;
    input.down([50, 150]);
    input.move([125, 150]);
    input.down([300, 150]);
    input.move([300, 150]);
    await client.barrier();
    near(client.state.camera.eye, [-8 * Math.SQRT1_2, 0, 8 * Math.SQRT1_2], 'no jump');
    input.move([375, 150]);
    input.up([375, 150]);
    await client.barrier();
    near(client.state.camera.eye, [-8, 0, 0], 'another 45 degrees');
  });

  test('a patch of camera in mid-drag makes the drag begin anew there', async (t) => {
    const client = await steering(t, server);
    const { input } = client;
    input.down([50, 150]);
    input.move([150, 150]);
    await client.patch({ camera: POSE });
    input.move([150, 150]);
    await client.barrier();
    nearCamera(client.state.camera, POSE, 'no jump');
    input.move([225, 150]);
    input.up([225, 150]);
    await client.barrier();
    near(client.state.camera.eye, [-8 * Math.SQRT1_2, 0, 8 * Math.SQRT1_2], '45 degrees from there');
  });

  test('a pointer is (client, pointerId): moves of another pointer are not those of the pressed one', async (t) => {
    const client = await steering(t, server);
    const { input } = client;
    input.down([50, 150]);
    input.move([125, 150], LEFT, { pointerId: 2, buttons: 0 });
    await client.barrier();
    nearCamera(client.state.camera, POSE, 'unmoved');
    input.up([50, 150]);
  });

  test('a second mouse button comes as pointermove with button >= 0; what is left held goes on', async (t) => {
    const client = await steering(t, server);
    const { input } = client;
    const point = await touched(client, [200, 150]);
    input.down([200, 150], LEFT);
    await input.pass(300);
    input.pointer('pointermove', [200, 150], { button: 2, buttons: 3 });
    input.pointer('pointermove', [200, 150], { button: 0, buttons: 2 });
    input.pointer('pointermove', [240, 150], { button: -1, buttons: 2 });
    input.pointer('pointerup', [240, 150], { button: 2, buttons: 0 });
    await client.barrier();
    nearCamera(client.state.camera, panned(POSE, 40, 0, point), 'a pan by the right button');
  });
});

describe('keys', () => {
  const ARROWS = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowDown: [0, 1], ArrowUp: [0, -1] };
  for (const [key, [right, down]] of Object.entries(ARROWS)) {
    test(`${key} turns by 5 degrees, with Shift pans by 5 % of the height`, async (t) => {
      const client = await steering(t, server, ASKEW);
      await client.patch({ navigation: { keepUpright: true } });
      const before = client.state.camera;
      await client.input.key(key, key);
      const turned = orbited(before, 5 * right, 5 * down);
      nearCamera(client.state.camera, turned, key);
      await client.patch({ camera: { ...POSE, ...ASKEW } });
      await client.input.key(key, key, { shiftKey: true });
      nearCamera(client.state.camera, panned(before, 15 * right, 15 * down), `Shift+${key}`);
    });
  }

  test('+ and - zoom by 1.1', async (t) => {
    const client = await steering(t, server);
    await client.input.key('+', 'NumpadAdd');
    near(client.state.camera.eye, [0, 0, 8 / 1.1], '+');
    await client.input.key('-', 'Minus');
    await client.input.key('-', 'Minus');
    near(client.state.camera.eye, [0, 0, 8.8], '-');
  });

  test('f fits the selection, or the scene', async (t) => {
    const client = await steering(t, server);
    await client.ask({ type: 'fit' });
    const whole = pose(client.state.camera);
    await client.ask({ type: 'fit', node: 4 });
    const door = pose(client.state.camera);
    await client.patch({ camera: POSE });
    await client.input.key('f', 'KeyF');
    assert.deepEqual(pose(client.state.camera), whole);
    await client.patch({ camera: POSE, selection: { node: 4 } });
    await client.input.key('f', 'KeyF');
    assert.deepEqual(pose(client.state.camera), door);
  });

  test('Home goes to the view "home"', async (t) => {
    const client = await steering(t, server);
    await client.input.key('Home', 'Home');
    const { home } = client.state.views;
    for (const member of ['eye', 'focus', 'center', 'fov']) assert.deepEqual(client.state.camera[member], home[member], member);
    await client.patch({ views: { home: { eye: [1, 2, 9] } } });
    await client.input.key('Home', 'Home');
    assert.deepEqual(client.state.camera.eye, [1, 2, 9]);
    await client.patch({ views: { home } });
  });

  test('w and s toggle wireframe and stylized', async (t) => {
    const client = await steering(t, server);
    const { mode, wireframe } = client.state.renderer;
    assert.deepEqual([mode, wireframe], ['realistic', false]);
    await client.input.key('w', 'KeyW');
    assert.equal(client.state.renderer.wireframe, true);
    await client.input.key('s', 'KeyS');
    assert.equal(client.state.renderer.mode, 'stylized');
    await client.input.key('w', 'KeyW');
    await client.input.key('s', 'KeyS');
    assert.deepEqual([client.state.renderer.mode, client.state.renderer.wireframe], ['realistic', false]);
  });

  test('Escape clears the selection', async (t) => {
    const client = await steering(t, server);
    await client.patch({ selection: { node: 4 } });
    await client.input.key('Escape', 'Escape');
    assert.deepEqual(client.state.selection, {});
  });

  test('Escape stops a flight, and keeps the selection', async (t) => {
    const client = await steering(t, server);
    await client.patch({ selection: { node: 4 } });
    const id = client.send({ type: 'fly', keyframes: [{ at: 20000, camera: { ...POSE, eye: [3, 0, 8] } }] });
    await client.answer(id);
    await client.input.key('Escape', 'Escape');
    const flown = await client.texted('flown');
    assert.deepEqual([flown.id, flown.completed], [id, false]);
    assert.equal(client.state.selection.node, 4);
  });

  test('other keys do nothing', async (t) => {
    const client = await steering(t, server);
    const { revision } = client;
    for (const [key, code] of [['x', 'KeyX'], ['Tab', 'Tab'], ['F5', 'F5'], ['Dead', 'BracketLeft'], ['é', 'Digit2']]) await client.input.key(key, code);
    assert.equal(client.revision, revision);
  });
});

// The contract names the styles; what they map to is what NAVIGATION.md and the programs themselves have in common.
describe('styles', () => {
  const ALT = { altKey: true };
  const CHANGES = {
    rotate: (before, now) => length(sub(now.eye, before.eye)) > 0.1 && Math.abs(dot(axes(now).view, axes(before).view)) < 0.999,
    pan: (before, now) => length(sub(now.eye, before.eye)) > 0.1 && dot(axes(now).view, axes(before).view) > 1 - 1e-9 && Math.abs(distance(now) - distance(before)) < 1e-9,
    zoom: (before, now) => Math.abs(distance(now) - distance(before)) > 0.1 && dot(axes(now).view, axes(before).view) > 1 - 1e-9,
  };
  const STYLES = {
    vrut: [['rotate', LEFT, {}], ['pan', RIGHT, {}], ['zoom', MIDDLE, {}]],
    maya: [['rotate', LEFT, ALT], ['pan', MIDDLE, ALT], ['zoom', RIGHT, ALT]],
    cinema4d: [['rotate', LEFT, ALT], ['pan', MIDDLE, ALT], ['zoom', RIGHT, ALT]],
    catia: [['pan', MIDDLE, {}]],
  };
  for (const [style, rows] of Object.entries(STYLES)) {
    for (const [operation, button, more] of rows) {
      test(`${style}: ${more.altKey ? 'Alt and ' : ''}${['left', 'middle', 'right'][button]} drag: ${operation}`, async (t) => {
        const client = await steering(t, server);
        await client.patch({ navigation: { style } });
        const before = client.state.camera;
        await client.input.drag([[200, 150], [230, 180], [260, 210]], button, more);
        assert.ok(CHANGES[operation](before, client.state.camera), JSON.stringify(pose(client.state.camera)));
        await client.patch({ navigation: null });
      });
    }
  }

  for (const style of Object.keys(STYLES)) {
    test(`${style}: touch, wheel and keys are as in the table`, async (t) => {
      const client = await steering(t, server);
      await client.patch({ navigation: { style } });
      await client.input.drag(DRAGGED, LEFT, { pointerType: 'touch' });
      near(client.state.camera.eye, [-8 * Math.SQRT1_2, 0, 8 * Math.SQRT1_2], 'one finger');
      await client.input.wheel(-100);
      near(distance(client.state.camera), 8 / 1.1, 'wheel');
      await client.patch({ navigation: null });
    });
  }
});

test('the view is along eye to focus, with up at right angles, after all of it', async (t) => {
  const client = await steering(t, server, ASKEW);
  for (let i = 0; i < 20; ++i) await client.input.drag([[200, 150], [10 + 19 * i, 280 - 13 * i]], [LEFT, RIGHT, MIDDLE][i % 3]);
  const { eye, focus, up } = client.state.camera;
  near(dot(up, unit(sub(focus, eye))), 0, 'up along the view');
  near(length(up), 1, 'up');
});

schemaTest(server);
