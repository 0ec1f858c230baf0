// SPDX-License-Identifier: Apache-2.0
// One file without network: scripts and styles within the page. Names without hashes: the same sources give the same bytes.
import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

export default defineConfig({
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  build: { target: "es2022", outDir: "dist", emptyOutDir: true, modulePreload: false, reportCompressedSize: false },
});
