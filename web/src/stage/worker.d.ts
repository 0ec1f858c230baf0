// SPDX-License-Identifier: Apache-2.0
declare module "*?worker&inline" {
  const Inline: new () => Worker;
  export default Inline;
}
