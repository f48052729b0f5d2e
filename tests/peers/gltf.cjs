// Validates glTF files with the validator of Khronos: `node gltf.cjs FILE...`. It prints a line for each file and every
// error and warning, and fails if there is one.
"use strict";

const fs = require("node:fs");
const validator = require("gltf-validator");

async function main(files) {
  let faults = files.length === 0 ? 1 : 0;
  for (const file of files) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    const { numErrors, numWarnings, numInfos, messages } = report.issues;
    const { animationCount, drawCallCount, totalTriangleCount } = report.info;
    console.log(
      `${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos; ` +
        `${animationCount} animations, ${drawCallCount} draw calls, ${totalTriangleCount} triangles`,
    );
    for (const { code, message, pointer, severity } of messages) {
      if (severity < 3) console.log(`  ${code} at ${pointer}: ${message}`);
    }
    faults += numErrors + numWarnings;
  }
  process.exitCode = faults > 0 ? 1 : 0;
}

// `--probe` only loads the validator.
if (process.argv[2] !== "--probe") main(process.argv.slice(2));
