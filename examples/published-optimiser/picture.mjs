// Takes the picture of the README: the top of a report page.
//
//     node picture.mjs PAGE.html PICTURE.png

import { chromium } from "../../tests/browser/node_modules/playwright-core/index.mjs";

const [, , page, picture] = process.argv;
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM || "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu"] });
const tab = await browser.newPage({ viewport: { width: 1180, height: 900 }, colorScheme: "dark", deviceScaleFactor: 1.5 });
await tab.goto(`file://${page}`);
await tab.waitForFunction(() => document.documentElement.dataset.shown !== undefined);
await tab.addStyleTag({ content: ".player { position: static !important } .overview { display: none }" });
await tab.waitForTimeout(500);
const top = await tab.locator(".job > header").boundingBox();
const scene = await tab.locator("figure.above").boundingBox();
await tab.screenshot({ path: picture, clip: { x: 10, y: top.y - 8, width: 1160, height: scene.y + scene.height - top.y + 14 } });
await browser.close();
