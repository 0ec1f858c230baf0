// SPDX-License-Identifier: Apache-2.0
import type { Panel } from "../panels";
export const closeupPanel: Panel = { id: "closeup", title: "Close-up", make: () => null };
