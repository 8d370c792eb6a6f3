// glb_validator.cjs CITY.glb: the Khronos validator finds no error.
const fs = require('node:fs');
const validator = require('gltf-validator');

async function main(path) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(path)));
  const { issues, info } = report;
  console.log(`${issues.numErrors} errors, ${issues.numWarnings} warnings, ` +
    `${info.totalTriangleCount} triangles, ${info.totalVertexCount} vertices`);
  for (const message of issues.messages.slice(0, 20)) {
    console.log(' ', message.severity, message.code, message.pointer ?? '', message.message);
  }
  if (issues.numErrors > 0) throw new Error(`${issues.numErrors} errors`);
  if (!(info.totalTriangleCount > 0)) throw new Error('no triangle');
}

main(process.argv[2]).catch((error) => {
  console.error(error.message);
  process.exit(1);
});
