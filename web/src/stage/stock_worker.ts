// SPDX-License-Identifier: Apache-2.0
// The stock's mesher in a worker of its own: one clock, then wishes; each is answered.
import { type ClockData, StockMesher, type StockWish } from "./stock_mesh";

let mesher: StockMesher | null = null;
self.onmessage = (event: MessageEvent<{ clock?: ClockData; wish?: StockWish }>): void => {
  const { clock, wish } = event.data;
  if (clock) mesher = new StockMesher(clock);
  if (!wish || !mesher) return;
  mesher.set(wish);
  const bricks = mesher.changed();
  (self as unknown as Worker).postMessage(bricks, bricks.flatMap(b => [b.position.buffer, b.normal.buffer, b.tint.buffer, b.index.buffer]));
};
