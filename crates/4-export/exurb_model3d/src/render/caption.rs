//! The attribution in the picture's corner.

use exurb_plan::font;

/// Writes light letters with a dark rim at the lower right.
pub fn write(pixels: &mut [u8], width_px: usize, text: &str) {
    let height_px = pixels.len() / 3 / width_px.max(1);
    let letter_px = (width_px as f32 / 190.0).clamp(5.0, 30.0);
    let room_px = width_px as f32 - 2.0 * letter_px;
    let text: String = text.chars().take(400).collect();
    let letter_px = letter_px.min(letter_px * room_px / font::width(&text, letter_px).max(1.0));
    let at =
        [width_px as f32 - letter_px - font::width(&text, letter_px), height_px as f32 - letter_px];
    let strokes = font::strokes(&text, at, letter_px);
    for (rim_px, shade, strength) in [(letter_px * 0.22, 0.0, 0.5), (letter_px * 0.08, 255.0, 0.95)]
    {
        for line in &strokes {
            for w in line.windows(2) {
                stroke(pixels, [width_px, height_px], [w[0], w[1]], rim_px, shade, strength);
            }
        }
    }
}

/// Blends `shade` in along a segment.
fn stroke(
    pixels: &mut [u8],
    [width, height]: [usize; 2],
    [a, b]: [[f32; 2]; 2],
    half_px: f32,
    shade: f32,
    strength: f32,
) {
    let reach = half_px + 1.0;
    let range = |p: f32, q: f32, limit: usize| {
        let from = (p.min(q) - reach).floor().max(0.0) as usize;
        let to = ((p.max(q) + reach).ceil().max(0.0) as usize).min(limit);
        from..to
    };
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let square = (dx * dx + dy * dy).max(1e-6);
    for y in range(a[1], b[1], height) {
        for x in range(a[0], b[0], width) {
            let (px, py) = (x as f32 + 0.5 - a[0], y as f32 + 0.5 - a[1]);
            let t = ((px * dx + py * dy) / square).clamp(0.0, 1.0);
            let (ex, ey) = (px - dx * t, py - dy * t);
            let cover = (half_px + 0.5 - (ex * ex + ey * ey).sqrt()).clamp(0.0, 1.0) * strength;
            for v in &mut pixels[(y * width + x) * 3..][..3] {
                *v = (f32::from(*v) + (shade - f32::from(*v)) * cover) as u8;
            }
        }
    }
}
