/** Vectors of three numbers. Each function returns a new one. */

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - b[1] * a[2], a[2] * b[0] - b[2] * a[0], a[0] * b[1] - b[0] * a[1]];
export const length = (a) => Math.sqrt(dot(a, a));
export const distance = (a, b) => length(subtract(b, a));
export const normalize = (a) => scale(a, 1 / length(a));
export const isFinite = (a) => a.every(Number.isFinite);
/** From a, 0, to b, 1. */
export const mix = (a, b, part) => add(a, scale(subtract(b, a), part));
