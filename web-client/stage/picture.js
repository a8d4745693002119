import { isSamePose, placeOf } from '../navigation/camera.js';
import { clippedPath, seenPath } from '../navigation/paths.js';
import { decodeDepthMap } from '../warp/depth-map.js';
import { surfaceSeen } from '../warp/surface.js';
import { similarity, withinReach } from './reach.js';
import { screenOf } from './screen.js';

/**
 * @import { FrameHeader } from '../base/protocol.js'
 * @import { Camera } from '../navigation/camera.js'
 * @import { Place } from '../navigation/drags.js'
 * @import { DepthMap } from '../warp/depth-map.js'
 * @import { Similarity } from './reach.js'
 */

/**
 * Shows frames on a canvas, none after a newer; `data-frame`, `data-level` and `data-revision` say which. Until the next
 * one comes it shows the last as another camera would see it: by its depth where it has any and WebGL 2 is there, else
 * moved and scaled.
 */
export class Picture {
  /** @type {?FrameHeader} of the frame last drawn; null before the first */
  header = null;
  #canvas;
  #decode;
  #screen;
  #received = 0;
  #drawn = 0;
  /** @type {{frame: number, map: Promise<?DepthMap>}} the newest that came */
  #depth = { frame: 0, map: Promise.resolve(null) };
  /** @type {?DepthMap} of the frame drawn */
  #map = null;
  /** @type {?Camera} that is asked for */
  #wanted = null;
  /** @type {Camera} whose view is shown, but for the move */
  #seen = /** @type {*} */ (null);
  /** @type {?Similarity} */
  #move = null;

  constructor(canvas, decode = (file) => createImageBitmap(file, { colorSpaceConversion: 'none' })) {
    this.#canvas = canvas;
    this.#decode = decode;
    this.#screen = screenOf(canvas, () => this.look(this.#wanted));
  }

  /** Whether depth is of use. */
  get warps() {
    return this.#screen.warps;
  }

  /**
   * Promises 'drawn', 'late' (a newer one was drawn first) or 'failed'. Who awaits this goes on before the page is
   * displayed, so that picture and look() can change together.
   */
  async show({ header, data }) {
    this.#received += 1;
    const turn = this.#received;
    const end = data.byteLength - (header?.depth?.bytes ?? 0);
    const depth = this.#depthOf(header, data, end);
    const file = new Blob([new Uint8Array(data, 0, end)], { type: 'image/jpeg' });
    const bitmap = header && (await this.#decode(file).catch(() => null));
    if (!bitmap) return 'failed';
    const map = await depth;
    if (turn < this.#drawn) {
      bitmap.close();
      return 'late';
    }
    this.#drawn = turn;
    this.#draw(header, bitmap, map);
    return 'drawn';
  }

  /** Shows what a camera sees, until the next frame comes; null: what the header's sees. @param {?Camera} camera */
  look(camera) {
    this.#wanted = camera;
    const { header } = this;
    if (!header) return;
    const from = drawnFrom(header);
    const asked = camera ?? header.camera;
    const isThere = isSamePose(asked, from);
    const isWarped = !isThere && this.#map !== null;
    this.#seen = isWarped ? withinReach(from, asked) : from;
    this.#screen.draw(isWarped ? { header, from, to: this.#seen } : null);
    this.#move = isThere || isWarped ? null : similarity(from, asked, this.#view);
    const { scale: factor, x, y } = this.#moved;
    const shrunk = shrinkage(this.#box, this.#view);
    const { style } = this.#canvas;
    style.transform = this.#move ? `translate(${x * shrunk}px, ${y * shrunk}px) scale(${factor})` : '';
  }

  /**
   * The point of the surface that a camera sees at a place of the view; null where nothing is, or it is not known.
   *
   * @param {Camera} camera
   * @param {Place} place
   */
  surfaceAt(camera, { x, y }) {
    if (!this.#map || !this.header) return null;
    const { width, height } = this.#view;
    const place = { x: 2 * x / width - 1, y: 2 * y / height - 1 };
    return surfaceSeen(this.#map, drawnFrom(this.header), camera, width / height, place);
  }

  /** To be called when the canvas has changed its place on the page. */
  layout() {
    const { width, height } = this.#box;
    this.#canvas.classList.toggle('fills', this.#view.width === width && this.#view.height === height);
    this.look(this.#wanted);
  }

  /** From the window's coordinates to those of the view shown, wherever the picture was moved. */
  mapping() {
    return viewMapping(this.#box, this.#view);
  }

  /**
   * How a camera's view lies on the window, whose pixels are `perPixel` of its own; null before the first frame.
   *
   * @param {Camera} camera
   */
  lens(camera) {
    if (!this.header) return null;
    const { width, height } = this.#view;
    const mapping = this.mapping();
    const origin = mapping(0, 0);
    const perPixel = mapping(1, 0).x - origin.x;
    const onWindow = ({ x, y }) => ({ x: (x - origin.x) / perPixel, y: (y - origin.y) / perPixel });
    return { lens: { camera, width, height }, perPixel, onWindow };
  }

  /** Where a point of the world is seen in the view; null where it is not. @returns {?Place} */
  placeOf(point) {
    if (!this.header) return null;
    const { width, height } = this.#view;
    const { x, y, depth } = placeOf(this.#seen, width / height, point);
    if (!(depth > 0) || Math.abs(x) > 1 || Math.abs(y) > 1) return null;
    const { scale: factor, x: right, y: down } = this.#moved;
    return { x: (x * factor + 1) * width / 2 + right, y: (y * factor + 1) * height / 2 + down };
  }

  /**
   * Where lines through points of the world are seen on the window, each in pieces.
   *
   * @param {number[][][]} lines
   * @returns {Place[][][]}
   */
  paths(lines) {
    const shown = this.lens(this.#seen);
    if (!shown) return lines.map(() => []);
    const { lens, onWindow } = shown;
    const { width, height } = lens;
    const { scale: factor, x: right, y: down } = this.#moved;
    const { x: left, y: top } = onWindow({ x: 0, y: 0 });
    const corner = onWindow({ x: width, y: height });
    const area = { left, top, right: corner.x, bottom: corner.y };
    const moved = ({ x, y }) => onWindow({
      x: (x - width / 2) * factor + width / 2 + right, y: (y - height / 2) * factor + height / 2 + down,
    });
    return lines.map((points) => seenPath(lens, points).flatMap((piece) => clippedPath(piece.map(moved), area)));
  }

  /**
   * Draws what is shown around a place of the window, so many times as large, all over a canvas.
   *
   * @param {HTMLCanvasElement} target with the window's pixels
   * @param {Place} place
   * @param {number} magnified
   */
  magnify(target, place, magnified) {
    const context = target.getContext('2d', { alpha: false });
    if (!context) return;
    context.clearRect(0, 0, target.width, target.height);
    if (!this.header) return;
    const { width, height } = this.#view;
    const { scale: factor, x: right, y: down } = this.#moved;
    const at = this.mapping()(place.x, place.y);
    const inPicture = this.#canvas.width / width;
    const x = ((at.x - right - width / 2) / factor + width / 2) * inPicture;
    const y = ((at.y - down - height / 2) / factor + height / 2) * inPicture;
    const pixel = inPicture / (shrinkage(this.#box, this.#view) * factor * magnified * globalThis.devicePixelRatio);
    const [across, tall] = [target.width * pixel, target.height * pixel];
    context.drawImage(this.#screen.image(), x - across / 2, y - tall / 2, across, tall, 0, 0, target.width, target.height);
  }

  /** How the frame's own view is moved and scaled about its middle. @returns {Similarity} */
  get #moved() {
    return this.#move ?? { scale: 1, x: 0, y: 0 };
  }

  /** Where the canvas is when it is not moved. */
  get #box() {
    const { offsetLeft: left, offsetTop: top, offsetWidth: width, offsetHeight: height } = this.#canvas;
    return { left, top, width, height };
  }

  get #view() {
    return this.header?.view ?? this.#box;
  }

  /** Frames of the same view have the map of the first of them. */
  async #depthOf(header, data, end) {
    const { depth } = header ?? {};
    if (!depth || !this.warps) return null;
    if (depth.bytes > 0) {
      this.#depth = { frame: depth.frame, map: decodeDepthMap(new Uint8Array(data, end), depth).catch(() => null) };
    }
    return this.#depth.frame === depth.frame ? this.#depth.map : null;
  }

  #draw(header, bitmap, map) {
    this.#map = map;
    this.#screen.setFrame(bitmap, map);
    this.header = header;
    this.#wanted = null;
    this.layout();
    const { frame, revision, quality } = header;
    Object.assign(this.#canvas.dataset, { frame, revision, level: quality?.level ?? '' });
  }
}

/** The server may draw ahead of the camera that the header names. @param {FrameHeader} header @returns {Camera} */
const drawnFrom = ({ camera, depth }) => depth?.camera ?? camera;

/** From the window's coordinates to those of a view that is fitted as a whole into the middle of a box. */
export function viewMapping(box, view) {
  const shrunk = shrinkage(box, view);
  return (clientX, clientY) => ({
    x: (clientX - box.left - box.width / 2) / shrunk + view.width / 2,
    y: (clientY - box.top - box.height / 2) / shrunk + view.height / 2,
  });
}

function shrinkage(box, view) {
  return Math.min(box.width / view.width, box.height / view.height);
}
