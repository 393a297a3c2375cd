// Where the sun stands at a date, an hour and a latitude; +z is south, +x is east, angles in degrees.

const toRadians = Math.PI / 180;

/** The sun's declination on a day of the year, 1 to 365, within 0.5 degrees (Cooper, "The absorption of radiation in solar
    stills", Solar Energy 12, 1969, equation 1). */
export const declination = (day: number): number => 23.45 * Math.sin(toRadians * (360 / 365) * (284 + day));

/** `hours`: local solar time, 0 to 24. Azimuth: 0 is +z (south), 90 is +x (east). */
export function sunAt(day: number, hours: number, latitude: number): { azimuth: number; elevation: number } {
  const angle = toRadians * 15 * (hours - 12),
    tilt = toRadians * declination(day),
    place = toRadians * latitude;
  const east = -Math.cos(tilt) * Math.sin(angle),
    up = Math.sin(place) * Math.sin(tilt) + Math.cos(place) * Math.cos(tilt) * Math.cos(angle),
    south = Math.sin(place) * Math.cos(tilt) * Math.cos(angle) - Math.cos(place) * Math.sin(tilt);
  return { azimuth: Math.atan2(east, south) / toRadians, elevation: Math.asin(Math.min(Math.max(up, -1), 1)) / toRadians };
}

/** The day of the year of "2026-06-21"; not a number where it is no date. */
export function dayOfYear(date: string): number {
  const [year, month, day] = date.split("-").map(Number);
  return (Date.UTC(year!, month! - 1, day) - Date.UTC(year!, 0, 0)) / 86400000;
}
