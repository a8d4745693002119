import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Meter } from '../../../web-client/connection/meter.js';

test('nothing is measured before anything came', () => {
  assert.deepEqual(new Meter().read(0), { p50: undefined, p95: undefined, framesPerSecond: 0, bytesPerSecond: 0 });
});

test('latency ends with the first frame that covers the message', () => {
  const meter = new Meter();
  meter.sent('pointermove', 7, 1000);
  meter.drawn(6, 10, 1010);
  assert.equal(meter.read(1010).p50, undefined);
  meter.drawn(8, 10, 1045);
  meter.drawn(8, 10, 1090);
  assert.equal(meter.read(1090).p50, 45);
  assert.equal(meter.read(1090).p95, 45);
});

test('every message that a frame covers counts', () => {
  const meter = new Meter();
  for (let id = 1; id <= 4; id += 1) meter.sent('pointermove', id, id * 10);
  meter.drawn(4, 10, 50);
  assert.equal(meter.read(50).p50, 20);
  assert.equal(meter.read(50).p95, 40);
});

test('only what moves the picture counts', () => {
  const meter = new Meter();
  for (const type of ['pointerdown', 'pointerup', 'pointercancel', 'keyup', 'patch']) meter.sent(type, 1, 0);
  meter.drawn(5, 10, 300);
  assert.equal(meter.read(300).p50, undefined);
  for (const [i, type] of ['pointermove', 'wheel', 'keydown'].entries()) meter.sent(type, 6 + i, 400);
  meter.drawn(8, 10, 420);
  assert.equal(meter.read(420).p95, 20);
});

test('the last hundred count', () => {
  const meter = new Meter();
  const measure = (id, ms) => {
    meter.sent('wheel', id, id * 1000);
    meter.drawn(id, 1, id * 1000 + ms);
  };
  for (let id = 1; id <= 100; id += 1) measure(id, 500);
  for (let id = 101; id <= 200; id += 1) measure(id, id - 100);
  const { p50, p95 } = meter.read(300_000);
  assert.equal(p50, 50);
  assert.equal(p95, 95);
});

test('what a much later frame covers is no latency, nor what another connection sent', () => {
  const meter = new Meter();
  meter.sent('keydown', 1, 0);
  meter.drawn(1, 1, 10_001);
  meter.sent('keydown', 2, 20_000);
  meter.forgetSent();
  meter.drawn(2, 1, 20_010);
  assert.equal(meter.read(20_010).p50, undefined);
});

test('rates are of the last two seconds, and nothing when idle', () => {
  const meter = new Meter();
  for (let i = 0; i < 10; i += 1) meter.drawn(0, 1000, i * 500);
  assert.deepEqual(meter.read(4500), { p50: undefined, p95: undefined, framesPerSecond: 2, bytesPerSecond: 2000 });
  assert.equal(meter.read(5600).framesPerSecond, 1);
  assert.equal(meter.read(6499).framesPerSecond, 0.5);
  assert.equal(meter.read(6500).framesPerSecond, 0);
  assert.equal(meter.read(6500).bytesPerSecond, 0);
});

test('how late pictures are: since the oldest message was sent that none covers', () => {
  const meter = new Meter();
  assert.equal(meter.lateMs(5), 0);
  meter.sent('pointermove', 1, 10);
  meter.sent('pointermove', 2, 30);
  assert.equal(meter.lateMs(100), 90);
  meter.drawn(1, 1, 100);
  assert.equal(meter.lateMs(100), 70);
});

test('a move without effect, long before, makes nothing late', () => {
  const meter = new Meter();
  meter.sent('keydown', 1, 0);
  meter.sent('pointermove', 2, 5000);
  assert.equal(meter.lateMs(5010), 10);
  meter.sent('pointermove', 3, 5250);
  assert.equal(meter.lateMs(6100), 1100);
});
