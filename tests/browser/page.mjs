// Opens a report page in Chromium and prints what a reader would see of it, as JSON.
//
//     node page.mjs PAGE.html CHECK
//
// CHECK: name of a check whose row is clicked. Any console error, failed script or request to a network ends it with
// exit code 1.

import { chromium } from "playwright-core";

const [, , file, check] = process.argv;
const FLAGS = [
  "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];
const executablePath = process.env.CHROMIUM || "/usr/bin/chromium";
const browser = await chromium.launch({ executablePath, args: FLAGS });
const complaints = [];

async function open(width, height, colorScheme) {
  const page = await browser.newPage({ viewport: { width, height }, colorScheme });
  page.on("console", (message) => message.type() === "error" && complaints.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => complaints.push(`script: ${error.message}`));
  page.on("request", (request) => /^(file|data|blob):/.test(request.url()) || complaints.push(`request: ${request.url()}`));
  await page.goto(`file://${file}`);
  await page.waitForFunction(() => document.documentElement.dataset.shown !== undefined);
  await page.waitForTimeout(300);
  return page;
}

const slider = (page) => page.locator(".player input");
const time = async (page) => Number(await slider(page).inputValue());
/** A picture of what moves in the scene seen from above. */
const picture = (page) => page.locator(".above canvas").last().evaluate((canvas) => canvas.toDataURL());
/** Pixels of a canvas that are not transparent. */
const inked = (page) => page.locator(".above canvas").last().evaluate((canvas) => {
  const pixels = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  return pixels.filter((value, index) => index % 4 === 3 && value > 0).length;
});

const page = await open(1440, 900, "dark");
const seen = { title: await page.title(), start_s: await time(page), verdict: await page.locator(".badge.verdict").first().textContent() };
seen.inked = await inked(page);

const before = await picture(page);
await slider(page).fill("1.5");
seen.slid_s = await time(page);
seen.output = await page.locator(".player output").textContent();
seen.moved = (await picture(page)) !== before;

await page.locator(".play").click();
await page.waitForTimeout(500);
await page.locator(".play").click();
seen.played_s = (await time(page)) - seen.slid_s;

const rows = page.locator(".checks tbody tr");
seen.rows = await rows.count();
seen.first_row = await rows.first().getAttribute("data-check");
await page.locator(`tr[data-check="${check}"]`).click();
seen.clicked_s = await time(page);
await page.locator(".filters button", { hasText: /^pass/ }).click();
seen.passed_rows = await rows.count();
await page.locator(".checks th button", { hasText: "margin" }).click();
const texts = await page.locator(".checks tbody tr td:nth-child(3)").allTextContents();
const margins = texts.filter((text) => text !== "").map(Number);
seen.is_sorted = margins.length > 1 && margins.every((margin, index) => index === 0 || margins[index - 1] <= margin);
seen.plots = await page.locator(".uplot").count();
await page.emulateMedia({ media: "print" });
await page.waitForTimeout(200);
seen.pdf_bytes = (await page.pdf({ format: "A4" })).length;

const phone = await open(390, 844, "light");
seen.phone_width = await phone.evaluate(() => document.documentElement.scrollWidth);

await browser.close();
if (complaints.length > 0) {
  console.error(complaints.join("\n"));
  process.exit(1);
}
console.log(JSON.stringify(seen));
