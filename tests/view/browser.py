"""Opens the live page as a user does; pictures go into the folder that is given. The fourth argument says how much is tried: "keys" or "all"."""

import shutil
import sys
import time

from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.support.select import Select
from selenium.webdriver.support.wait import WebDriverWait

url, folder, program, what = sys.argv[1:]
options = webdriver.ChromeOptions()
for option in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1280,1200"):
    options.add_argument(option)
options.binary_location = shutil.which(program)
options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
browser = webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
browser.set_script_timeout(60)
# Remembers the labels of the plot: text, box of its letters, and the box of its line for labels of causes.
browser.execute_cdp_cmd(
    "Page.addScriptToEvaluateOnNewDocument",
    {
        "source": """
        const { fillText, setTransform } = CanvasRenderingContext2D.prototype;
        window.labels = [];
        // Begins a drawing.
        CanvasRenderingContext2D.prototype.setTransform = function (...all) { window.labels = []; return setTransform.apply(this, all); };
        CanvasRenderingContext2D.prototype.fillText = function (text, x, y) {
          const size = this.measureText(text), isCause = text.startsWith("causes ");
          const [up, down] = isCause ? [size.fontBoundingBoxAscent, size.fontBoundingBoxDescent] : [size.actualBoundingBoxAscent, size.actualBoundingBoxDescent];
          window.labels.push({ text, isCause, left: x - size.actualBoundingBoxLeft, right: x + size.actualBoundingBoxRight, top: y - up, bottom: y + down });
          return fillText.call(this, text, x, y);
        };
        """
    },
)
patient = WebDriverWait(browser, 120)


def one(css):
    return browser.find_element(By.CSS_SELECTOR, css)


def text(css):
    return one(css).text


def until(what, holds):
    try:
        patient.until(lambda _: holds())
    except Exception:
        browser.save_screenshot(f"{folder}/failed.png")
        raise AssertionError(f"{what}: not within two minutes; {folder}/failed.png") from None


def key(name):
    ActionChains(browser).send_keys(name).perform()


def pressed(css):
    return one(css).get_attribute("aria-pressed") == "true"


def ink():
    """Points of the plot that have the colour of a channel: nothing is drawn without any."""
    return browser.execute_script(
        """
        const canvas = document.getElementById("plot");
        const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
        let count = 0;
        for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 200 && Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 60) count++;
        return count;
        """
    )


def label():
    return one("#plot").get_attribute("aria-label")


def labels():
    """The labels of the plot that lie on each other or beside the plot, and how many there are of causes. Labels of causes keep the height of a line apart, others
    that of their letters."""
    return browser.execute_script(
        """
        const canvas = document.getElementById("plot"), over = [];
        const [width, height] = [canvas.clientWidth, canvas.clientHeight];
        window.labels.forEach((a, i) => {
          if (a.left < 0 || a.right > width || a.top < 0 || a.bottom > height) over.push([a.text, "sticks out"]);
          for (const b of window.labels.slice(i + 1)) if (a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom) over.push([a.text, b.text]);
        });
        return { over, causes: window.labels.filter((a) => a.isCause).length, all: window.labels.length };
        """
    )


def drawn():
    """How the histograms look: how bright their letters are (three bytes summed), whether they are on the page's paper, how high the smallest letters are on
    the screen, and which of its texts lie on each other or beside the drawing."""
    return browser.execute_script(
        """
        const all = [...document.querySelectorAll("#margin svg")].map((svg) => {
        const frame = svg.getBoundingClientRect();
        const texts = [...svg.querySelectorAll("text")].filter((t) => t.textContent);
        const boxes = texts.map((t) => [t.textContent, t.getBoundingClientRect()]);
        const over = [];
        boxes.forEach(([name, a], i) => {
          if (a.left < frame.left - 1 || a.right > frame.right + 1) over.push([name, "sticks out"]);
          // A line's box is higher than its letters.
          for (const [other, b] of boxes.slice(i + 1)) if (a.left < b.right && b.left < a.right && a.top + 3 < b.bottom && b.top + 3 < a.bottom) over.push([name, other]);
        });
        const paper = svg.querySelector("rect:not([class])");
        return {
          ink: getComputedStyle(texts[0]).fill.match(/\\d+/g).slice(0, 3).reduce((all, n) => all + Number(n), 0),
          paper: paper ? getComputedStyle(paper).fill : "none",
          least: Math.min(...texts.map((t) => parseFloat(getComputedStyle(t).fontSize) * t.getScreenCTM().a)),
          over,
        };
        });
        return {
          ink: Math.min(...all.map((a) => a.ink)), paper: all.every((a) => a.paper === "none"),
          least: Math.min(...all.map((a) => a.least)), over: all.flatMap((a) => a.over),
        };
        """
    )


def has_no_errors():
    wrong = [e for e in browser.get_log("browser") if e["level"] == "SEVERE"]
    assert not wrong, wrong


try:
    # Who has no token is told where it is; who has come with it once needs it no more, nor is it left in the address.
    page = url.split("?")[0]
    browser.get(page)
    assert "the address that the program has printed" in text("body"), text("body")
    # The browser says so, too; what it says from here on is something else.
    assert all("403" in e["message"] for e in browser.get_log("browser"))
    browser.get(url)
    assert browser.current_url == page, browser.current_url
    until("live", lambda: text("#link") == "live")
    until("both channels are good", lambda: [p.text for p in browser.find_elements(By.CSS_SELECTOR, ".channel .pill")] == ["good"] * 2)
    assert "deg" in text(".channel .value") and "line delay" in text(".channel .about")
    until("a plot", lambda: ink() > 200)
    first = text(".channel .value")
    until("the position moves", lambda: text(".channel .value") != first)
    time.sleep(2)
    browser.save_screenshot(f"{folder}/wide.png")

    # Keys.
    key("v")
    until("velocity", lambda: label().startswith("velocity") and pressed('[data-show="velocity"]'))
    until("velocities are drawn", lambda: ink() > 200)
    key("d")
    until("difference", lambda: label().startswith("difference"))
    key("p")
    until("position", lambda: label().startswith("position"))
    assert pressed("#live")
    key("+")
    until("not live any more", lambda: not pressed("#live"))
    seconds = lambda: [float(t) for t in label().replace(" s", "").replace("from ", "").split("time, ")[1].split(" to ")]
    time.sleep(0.5)
    before = seconds()
    key("-")
    until("zoomed out", lambda: seconds()[1] - seconds()[0] > before[1] - before[0])
    key("l")
    until("live again", lambda: pressed("#live"))
    key("z")
    until("the zero is now", lambda: "from the zero that was set" in text(".channel .about"))
    assert abs(float(text(".channel .value").split()[0])) < 60
    key("x")
    until("absolute again", lambda: "from the zero" not in text(".channel .about"))
    # The mouse says what is there.
    ActionChains(browser).move_to_element(one("#plot")).perform()
    until("what the pointer is on", lambda: "channel 1:" in text("#cursor") and "deg" in text("#cursor"))

    if what == "keys":
        has_no_errors()
        sys.exit()

    # What else there is.
    one('[data-tab="encoders"]').click()
    assert "measuring steps per revolution" in text("#encoders") and not one("#causes").is_displayed()
    one('[data-tab="registers"]').click()
    one("#register-search").send_keys("result0 status")
    one("#register-list button").click()
    until("a register", lambda: "fresh" in text("#register-value"))
    one("#register-search").clear()
    one("#register-search").send_keys("position_bits")
    until("a register by its field", lambda: "config0.frame" in text("#register-list") and "position_bits: " in text("#register-list"))
    one("#register-search").clear()
    one("#register-search").send_keys("no_such_word")
    until("nothing", lambda: text("#register-list") == "")
    one('[data-tab="memory"]').click()
    one('#parameter input[name="address"]').clear()
    one('#parameter input[name="address"]').send_keys("13")
    one("#parameter button").click()
    until("a parameter", lambda: text("#parameter-value").startswith("0x801D"))
    one('[data-tab="margin"]').click()
    until("a histogram", lambda: browser.execute_script("return [...document.querySelectorAll('#margin svg')].filter(s => s.querySelector('.edges') && s.querySelector('.open')).length") == 2)
    assert "margin 2" in text("#margin figcaption") and "eye: open for" in text("#margin figcaption"), text("#margin figcaption")
    browser.execute_script("document.getElementById('more').scrollIntoView()")
    browser.save_screenshot(f"{folder}/margin.png")
    browser.execute_script("scrollTo(0, 0)")

    # A request of the parameter took two triggers; they are told with what they mean.
    one('[data-tab="causes"]').click()
    until("causes", lambda: "not_taken" in text("#causes") and "was busy" in text("#causes"))

    # A recording, and a second page that sees it.
    high = "return document.querySelector('header').offsetHeight"
    before = browser.execute_script(high)
    key("r")
    until("a recording", lambda: "rows in recordings" in text("#recording"))
    assert browser.execute_script(high) == before, "the header jumps"
    here = browser.current_window_handle
    browser.switch_to.new_window("tab")
    browser.get(page)
    until("the second page sees it", lambda: "rows in recordings" in text("#recording"))
    one("#record").click()
    until("its end", lambda: text("#record") == "Record")
    browser.close()
    browser.switch_to.window(here)
    until("its end on the first page", lambda: text("#record") == "Record")

    # Dark and narrow: nothing sticks out.
    one("#theme").click()
    assert browser.execute_script("return document.documentElement.dataset.theme") == "dark"
    phone = {"width": 390, "height": 1600, "deviceScaleFactor": 2, "mobile": True}
    browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", phone)
    one("[data-tab=causes]").click()
    until("causes of the requests above", lambda: "not_taken" in text("#causes"))
    time.sleep(1)
    browser.save_screenshot(f"{folder}/narrow.png")
    found = labels()
    assert found["causes"] == 2 and found["all"] >= 6 and not found["over"], found
    one("[data-tab=margin]").click()
    # Of this page's colours, and large enough to be read; nothing is cut off or lies on another text.
    look = {}

    def legible():
        look.update(drawn())
        return look["ink"] > 450 and look["paper"] and look["least"] >= 8 and not look["over"]

    try:
        until("a histogram that is legible", legible)
    except AssertionError:
        raise AssertionError(look) from None
    browser.execute_script("document.getElementById('more').scrollIntoView()")
    browser.save_screenshot(f"{folder}/margin-narrow.png")
    # A channel that is unplugged says so, and still shows the last position that it had.
    one('[data-tab="rehearsal"]').click()
    fault = Select(one('#inject select[name="fault"]'))
    channel = one('#inject input[name="channel"]')
    channel.clear()
    channel.send_keys("1")
    fault.select_by_visible_text("unplug")
    one("#inject button").click()
    until("the fault", lambda: text("#inject-done") != "")
    second = lambda css: browser.find_elements(By.CSS_SELECTOR, ".channel " + css)[1].text
    until("held, and why", lambda: second(".pill").startswith("held: "))
    time.sleep(1)
    held = second(".value")
    assert held.endswith("deg") and float(held.split()[0]) >= 0, held
    time.sleep(1)
    assert second(".value") == held and second(".pill").startswith("held: "), (second(".value"), second(".pill"))
    until("the other one is good", lambda: browser.find_elements(By.CSS_SELECTOR, ".channel .pill")[0].text == "good")
    browser.save_screenshot(f"{folder}/held.png")
    wide = browser.execute_script("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wide <= 0, f"{wide} pixels stick out"
    has_no_errors()
finally:
    browser.quit()
