import { element } from '../base/element.js';
import { componentWords, valueWords } from '../base/measures.js';
import { clippedPath, middleOfPaths } from '../navigation/paths.js';
import { layOut, leaderOf } from './chip-layout.js';
import { dotData, pathData } from './snap-signs.js';

/**
 * @import { Measure, Unit } from '../base/measures.js'
 * @import { Place } from '../navigation/drags.js'
 * @import { Area } from '../navigation/plane-drags.js'
 * @import { Laid, Wanted } from './chip-layout.js'
 *
 * @typedef {{chip: HTMLElement, words: string, width: number, height: number}} Chip
 */

/** The ends of a line, each as one of no length; a closed one has none. @param {number[][]} line */
function endsOf(line) {
  const ends = line.slice(0, 1).concat(line.slice(-1));
  return String(ends[0]) === String(ends[1]) ? [] : ends.map((end) => [end, end]);
}

/** @param {Measure} measure @param {Unit} unit @returns {string[]} a line for each axis, or none */
function alongAxes(measure, unit) {
  const parts = Object.entries(componentWords(measure, unit) ?? {});
  return parts.map(([axis, words]) => `${axis.toUpperCase()} ${words}`);
}

/** Pixels of a line that its value is to leave free, or else it lies beside. */
const SHOWN = 24;

/** How far lines reach across or down. @param {Place[][]} lines */
function extentOf(lines) {
  const reach = (numbers) => Math.max(...numbers) - Math.min(...numbers);
  const places = lines.flat();
  return Math.max(reach(places.map(({ x }) => x)), reach(places.map(({ y }) => y)));
}

/** Draws measures over the picture: their lines, and their values in chips that do not cover each other. */
export class MeasureMarks {
  #svg;
  #container;
  /** @type {Map<string, Chip>} by the measure's name */
  #chips = new Map();
  /** @type {Map<string, number>} where the chips were laid out */
  #slots = new Map();
  /** The distances whose components are shown. @type {Set<string>} */
  #opened = new Set();
  #redraw;

  /** @param {Element} svg @param {HTMLElement} container both as large as the window @param {() => void} redraw */
  constructor(svg, container, redraw) {
    this.#svg = svg;
    this.#container = container;
    this.#redraw = redraw;
  }

  /**
   * @param {{paths: (lines: number[][][]) => Place[][][]}} picture where lines are seen on the window, in pieces
   * @param {Record<string, Measure>} measures
   * @param {Unit} unit
   * @param {() => Area} uncovered what no panel covers of the window
   */
  show(picture, measures, unit, uncovered) {
    const all = Object.entries(measures);
    if (all.length === 0 && this.#chips.size === 0) return;
    const lines = all.map(([, { line = [] }]) => line);
    const seen = picture.paths(lines);
    const ends = picture.paths(lines.flatMap(endsOf)).flatMap(([piece]) => piece?.slice(0, 1) ?? []);
    const area = uncovered();
    /** @type {Wanted[]} */
    const wanted = [];
    for (const [i, [name, measure]] of all.entries()) {
      const free = measure.value === undefined ? [] : seen[i].flatMap((piece) => clippedPath(piece, area));
      const at = middleOfPaths(free);
      if (!at) continue;
      const { width, height } = this.#chip(name, measure, unit);
      wanted.push({ name, at, width, height, isBeside: extentOf(free) < width + SHOWN });
    }
    const laid = layOut(wanted, area, this.#slots);
    this.#slots = new Map(laid.map(({ name, slot }) => [name, slot]));
    this.#drawLines(seen, ends, laid);
    this.#place(laid);
    this.#forget(measures);
  }

  /** @param {Place[][][]} seen @param {Place[]} ends @param {Laid[]} laid */
  #drawLines(seen, ends, laid) {
    const lines = pathData(seen.flat());
    const leaders = laid.flatMap((one) => leaderOf(one, /** @type {Chip} */ (this.#chips.get(one.name))) ?? []);
    for (const part of this.#svg.querySelectorAll('.line')) part.setAttribute('d', lines);
    this.#svg.querySelector('.leader')?.setAttribute('d', pathData(leaders));
    this.#svg.querySelector('.ends')?.setAttribute('d', dotData(ends));
  }

  /** @param {Laid[]} laid */
  #place(laid) {
    const places = new Map(laid.map((one) => [one.name, one]));
    for (const [name, { chip }] of this.#chips) {
      const place = places.get(name);
      // Not `hidden`: it would have no size.
      chip.classList.toggle('away', !place);
      if (place) chip.style.transform = `translate(${place.x.toFixed(1)}px, ${place.y.toFixed(1)}px) translate(-50%, -50%)`;
    }
  }

  /** @param {Record<string, Measure>} measures those that are left */
  #forget(measures) {
    for (const [name, { chip }] of this.#chips) {
      if (Object.hasOwn(measures, name)) continue;
      chip.remove();
      this.#chips.delete(name);
      this.#opened.delete(name);
    }
  }

  /** The chip of a measure, with its words of now, and its size. @returns {Chip} */
  #chip(name, measure, unit) {
    const isOpened = this.#opened.has(name);
    const lines = [valueWords(measure, unit), ...(isOpened ? alongAxes(measure, unit) : [])];
    const before = this.#chips.get(name);
    const chip = before?.chip ?? this.#container.appendChild(this.#made(name, measure));
    const words = lines.join('\n');
    if (words === before?.words) return before;
    chip.replaceChildren(...lines.map((line) => element('span', {}, line)));
    if (measure.components) chip.ariaExpanded = String(isOpened);
    const made = { chip, words, width: chip.offsetWidth, height: chip.offsetHeight };
    this.#chips.set(name, made);
    return made;
  }

  /** A distance unfolds how far it is along each axis. */
  #made(name, { kind }) {
    if (kind !== 'distance') return element('p', { data: { measure: name } });
    const turn = () => {
      if (!this.#opened.delete(name)) this.#opened.add(name);
      this.#redraw();
    };
    // The menu has the same for the keys.
    return element('button', { type: 'button', tabIndex: -1, onclick: turn, data: { measure: name } });
  }
}
