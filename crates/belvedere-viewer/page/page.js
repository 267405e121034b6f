/* Made from src/ by page/build: change those files. Contains three.js, MIT licence: see THREE-LICENSE */
(()=>{var Hh={texts:{"1 corner.":"1 Ecke.","1 scene is kept in this browser ({0} MB): the same files open in a moment.":"1 Szene ist in diesem Browser gespeichert ({0} MB): Dieselben Dateien \xF6ffnen sich sofort.","1 under a free sky, 0 without any sky.":"1 unter freiem Himmel, 0 ganz ohne Himmel.","A file on the web, a reference system, a part of a file":"Eine Datei im Web, ein Bezugssystem, ein Ausschnitt einer Datei","A first answer from a sample of them; the exact one follows \u2026":"Eine erste Antwort aus einer Stichprobe davon; die genaue folgt \u2026","A first answer from a sample of {0} points; the exact one follows \u2026":"Eine erste Antwort aus einer Stichprobe von {0} Punkten; die genaue folgt \u2026","A to B":"A nach B",About:"Etwa","Address of a file on the web, or of a catalogue of tiles (.vpc, STAC); of COPC, only the part that is opened is transferred":"Adresse einer Datei im Internet oder eines Katalogs von Kacheln (.vpc, STAC); von COPC wird nur der ge\xF6ffnete Teil \xFCbertragen",After:"Nachher","Ahead (W)":"Vorw\xE4rts (W)",Answer:"Antwort","Answered in {0} ms.":"In {0} ms beantwortet.","Answers before or after the plan, or the change":"Antworten vor oder nach dem Plan oder die \xC4nderung","Area in its plane":"Fl\xE4che in ihrer Ebene","Area of the plane":"Gr\xF6\xDFe der Dachfl\xE4che","Area on the map":"Fl\xE4che auf der Karte","As measured":"Wie gemessen",Ask:"Fragen","Ask about this place":"Fragen zu dieser Stelle","Ask at the centre of the view":"In der Bildmitte fragen","Asking \u2026":"Die Antwort wird berechnet \u2026","At least three corners are needed.":"Es sind mindestens drei Ecken n\xF6tig.","At the time below":"Zur unten gew\xE4hlten Zeit","Axis that is up":"Achse, die nach oben zeigt","Azimuth of the sun":"Azimut der Sonne","B is blocked":"B ist verdeckt","B is unproven":"Die Sicht auf B ist unbewiesen","B is visible from A":"B ist von A aus sichtbar","Back (S)":"R\xFCckw\xE4rts (S)",Balls:"Kugeln",Before:"Vorher","Before, after, change of a plan":"Vorher, Nachher, \xC4nderung eines Plans","Between the two times":"Zwischen den beiden Zeiten","Blocked after":"Verdeckt nach","Blocked at":"Verdeckt bei","Building {0}":"Geb\xE4ude {0}",Cancel:"Abbrechen",Cells:"Zellen",Change:"\xC4nderung","Change of the hours of sun":"\xC4nderung der Sonnenstunden","Changing the scene \u2026":"Die Szene wird ge\xE4ndert \u2026","Choose a day below.":"W\xE4hlen Sie unten einen Tag.","Choose a question":"Frage w\xE4hlen","Choose a question on the left, then click a place. Every answer is computed by the program on this computer, and shows the command that gives the same.":"W\xE4hlen Sie links eine Frage und klicken Sie dann auf eine Stelle. Jede Antwort wird vom Programm auf diesem Computer berechnet und zeigt den Befehl, der dasselbe ergibt.","Choose a question on the left. This file holds the answers that were computed when it was made, each with the command that gives the same.":"W\xE4hlen Sie links eine Frage. Diese Datei enth\xE4lt die Antworten, die bei ihrer Erstellung berechnet wurden, jeweils mit dem Befehl, der dasselbe ergibt.","Choose a viewpoint: its view is in this file.":"W\xE4hlen Sie einen Standpunkt: Die Sicht von dort ist in dieser Datei enthalten.","Choose another date or time below.":"W\xE4hlen Sie unten ein anderes Datum oder eine andere Zeit.","Choose files":"Dateien w\xE4hlen","Choose the files again: they are read as chosen below.":"W\xE4hlen Sie die Dateien noch einmal: Sie werden gelesen, wie unten gew\xE4hlt.",Class:"Klasse","Clear an area":"Fl\xE4che r\xE4umen","Cleared area {0}":"Ger\xE4umte Fl\xE4che {0}","Click A, where the eye is, then B.":"Klicken Sie auf A, wo das Auge ist, und dann auf B.","Click a place to measure its sky view and the space that is visible from it.":"Klicken Sie auf eine Stelle, um zu messen, wie viel Himmel und wie viel Raum von dort zu sehen ist.","Click a place to see when the sun reaches it.":"Klicken Sie auf eine Stelle, um zu sehen, wann die Sonne sie erreicht.","Click a roof to see what sun and sky send to its plane in a year of clear sky.":"Klicken Sie auf ein Dach, um zu sehen, wie viel Energie Sonne und Himmel in einem Jahr ohne Wolken auf seine Fl\xE4che strahlen.","Click a target to see from where people can see it.":"Klicken Sie auf ein Ziel, um zu sehen, von wo aus man es sehen kann.","Click anywhere to ask":"Klicken Sie irgendwohin, um zu fragen","Click around what shall go, such as a tree or a house.":"Klicken Sie rund um das, was weg soll, etwa einen Baum oder ein Haus.","Click more places for a longer line or an area.":"Klicken Sie auf weitere Stellen f\xFCr eine l\xE4ngere Linie oder eine Fl\xE4che.","Click more, or go on with these.":"Klicken Sie auf weitere oder fahren Sie mit diesen fort.","Click more.":"Klicken Sie auf weitere.","Click places to measure between them.":"Klicken Sie auf Stellen, um zwischen ihnen zu messen.","Click the corners of the area.":"Klicken Sie auf die Ecken der Fl\xE4che.","Click the corners of the building.":"Klicken Sie auf die Ecken des Geb\xE4udes.","Click the opposite corner.":"Klicken Sie auf die gegen\xFCberliegende Ecke.","Click two corners, or move the heights.":"Klicken Sie auf zwei Ecken oder verschieben Sie die H\xF6hen.","Click two places for a length, more for an area.":"Klicken Sie auf zwei Stellen f\xFCr eine L\xE4nge, auf mehr f\xFCr eine Fl\xE4che.","Click where somebody stands: ground, balcony or roof.":"Klicken Sie dorthin, wo jemand steht: Boden, Balkon oder Dach.",Close:"Schlie\xDFen","Close the answer":"Antwort schlie\xDFen",Colour:"Farbe","Colour of the points":"Farbe der Punkte","Compare no longer":"Nicht mehr vergleichen","Compare this time with another":"Diese Zeit mit einer anderen vergleichen","Coordinates under the pointer":"Koordinaten unter dem Mauszeiger",Copied:"Kopiert","Copy command":"Befehl kopieren",Cut:"Ausschnitt",Dark:"Dunkel",Date:"Datum","Date and time":"Datum und Uhrzeit","Read it again":"Neu lesen","Read it with y up":"Mit y nach oben lesen","Read it with z up":"Mit z nach oben lesen","Reference system":"Bezugssystem","Share of open directions":"Anteil offener Richtungen",Size:"Gr\xF6\xDFe","The cloud, and how it is read":"Die Punktwolke und wie sie gelesen wird","Times are those of {0}.":"Uhrzeiten gelten in der Zeitzone {0}.","To read it with another reference system or up axis, end the program and start it with --crs or --up.":"F\xFCr ein anderes Bezugssystem oder eine andere Hochachse: Programm beenden und mit --crs oder --up starten.","Unit, where the file names none":"Einheit, wenn die Datei keine nennt","Unit, which the files do not name":"Einheit, die die Dateien nicht nennen",centimetres:"Zentimeter","deck, canopy or balcony":"Deck, Vordach oder Balkon","Down (Q)":"Abw\xE4rts (Q)","Drag to turn, right drag to move, wheel to zoom. Click a point for its coordinates.":"Ziehen dreht, Ziehen mit der rechten Maustaste verschiebt, das Mausrad zoomt. Klicken Sie auf einen Punkt, um seine Koordinaten zu sehen.","Draw a building":"Geb\xE4ude zeichnen","Draw or load what is planned, clear what goes; then ask again.":"Zeichnen oder laden Sie, was geplant ist, und r\xE4umen Sie, was wegf\xE4llt; fragen Sie dann noch einmal.",E:"O","Earlier or later":"Uhrzeit zur\xFCck oder vor",Edges:"Kanten","Elevation of the sun":"Sonnenh\xF6he","Eye above A":"Auge \xFCber A","Eye above the clicked point":"Auge \xFCber dem angeklickten Punkt",Faces:"Ausrichtung","Farthest view in plan":"Weiteste Sicht im Grundriss",Finish:"Fertig","First light":"Erste Sonne",Fly:"Fliegen",Forget:"L\xF6schen","From above":"Von oben","From the clicked place":"Von der angeklickten Stelle aus","From viewpoint {0}":"Von Standpunkt {0} aus","From where the place is seen":"Von wo die Stelle zu sehen ist","From {0} cells nothing is in the way, but no pulse proves it.":"Von {0} Zellen aus steht nichts im Weg, aber kein Laserpuls beweist es.","Gains sun":"Gewinnt Sonne",Go:"Fortbewegen","Go ahead":"Vorw\xE4rts bewegen","Go back":"R\xFCckw\xE4rts bewegen","Go down":"Abw\xE4rts bewegen","Go left":"Nach links bewegen","Go right":"Nach rechts bewegen","Go up":"Aufw\xE4rts bewegen","Greatest gain":"Gr\xF6\xDFter Gewinn","Greatest loss":"Gr\xF6\xDFter Verlust","Ground (brown), obstacles (grey) and the line of sight":"Boden (braun), Hindernisse (grau) und die Sichtlinie","Ground in the area":"Boden in der Fl\xE4che",Height:"H\xF6he","Height above the clicked point":"H\xF6he \xFCber dem angeklickten Punkt","Height of building {0} in metres":"H\xF6he von Geb\xE4ude {0} in Metern","Height of the building":"H\xF6he des Geb\xE4udes","Height of the last above the first":"H\xF6he des letzten Punkts \xFCber dem ersten",Help:"Hilfe","Hours of sun on the 21st of each month":"Sonnenstunden am 21. jedes Monats","Hours of sun on the day":"Sonnenstunden an diesem Tag","How likely it is lit":"Wahrscheinlichkeit, besonnt zu sein","How likely it is visible":"Wahrscheinlichkeit, sichtbar zu sein","In nine of ten cases":"In neun von zehn F\xE4llen",Intensity:"Intensit\xE4t","Is B seen from A":"Sicht von A nach B","It is {0} there now, and the sun is down or near the horizon: this is noon, when it stands highest.":"Dort ist es jetzt {0} Uhr, und die Sonne steht unter oder nahe dem Horizont: Gezeigt wird der Mittag, wenn sie am h\xF6chsten steht.","Its height":"H\xF6he der Fl\xE4che","Its points":"Punkte darauf","Keys and help (?)":"Tasten und Hilfe (?)","LAZ, LAS, COPC, E57, PLY, PCD, PTX, text; with them models and maps: OBJ, CityJSON, GeoTIFF, GeoJSON":"LAZ, LAS, COPC, E57, PLY, PCD, PTX, Text; dazu Modelle und Karten: OBJ, CityJSON, GeoTIFF, GeoJSON",Language:"Sprache","Last light":"Letzte Sonne",Least:"Kleinster Wert","Left (A)":"Nach links (A)",Legend:"Legende",Length:"L\xE4nge","Length of the line":"L\xE4nge der Linie","Length on the map":"L\xE4nge auf der Karte","Less sure, or unproven":"Weniger sicher oder unbewiesen","Let light through":"Lichtdurchl\xE4ssig",Light:"Hell","Light or dark":"Hell oder dunkel","Light or dark (L)":"Hell oder dunkel (L)","Lit, but unproven":"Besonnt, aber unbewiesen","Load a mesh":"3D-Modell laden","Longest stretch":"L\xE4ngste Zeit am St\xFCck",Look:"Umsehen","Look around":"Sich umsehen","Look straight down, north up (T)":"Senkrecht nach unten blicken, Norden oben (T)","Loses sun":"Verliert Sonne","Lost by shade, each panel for itself":"Schattenverlust, jedes Modul einzeln","Lost by shade, panels in strings":"Schattenverlust, Module in Reihenschaltung",Map:"Karte",Measure:"Messen","Measure lengths, heights and areas (R)":"L\xE4ngen, H\xF6hen und Fl\xE4chen messen (R)","Mesh file":"Datei mit 3D-Modell",Meshes:"3D-Modelle",Most:"Gr\xF6\xDFter Wert",Move:"Modus","Move the time, or play the day.":"Verschieben Sie die Uhrzeit oder spielen Sie den Tag ab.","Move; down and up":"Bewegen; abw\xE4rts und aufw\xE4rts",N:"N","Nearest obstacle in plan":"N\xE4chstes Hindernis im Grundriss","Next colour":"N\xE4chste Farbe","Next way of moving":"N\xE4chste Art der Bewegung","No answer":"Keine Antwort","No answer: A or B is inside an obstacle":"Keine Antwort: A oder B liegt in einem Hindernis","No answer: outside the cloud":"Keine Antwort: au\xDFerhalb der Punktwolke","No ground is known that sees it":"Kein Boden bekannt, von dem aus man es sieht","No scan at hand?":"Kein Scan zur Hand?","No tile of the catalogue lies there.":"Dort liegt keine Kachel des Katalogs.","Not above":"Nicht h\xF6her als","Not below":"Nicht tiefer als","Nothing blocks what is unproven, but part of the line runs through space that no laser pulse has seen.":"Was unbewiesen ist, wird von nichts verdeckt, aber ein Teil der Sichtlinie verl\xE4uft durch Raum, den kein Laserpuls erfasst hat.","Nothing stands in the line.":"Der Sichtlinie steht nichts im Weg.","Now click B.":"Klicken Sie jetzt auf B.","One finger turns, two fingers move and zoom. Tap a point for its coordinates.":"Ein Finger dreht, zwei Finger verschieben und zoomen. Tippen Sie auf einen Punkt, um seine Koordinaten zu sehen.",Open:"\xD6ffnen","Open a laser scan of a place, and click to ask. Trees, balconies and bridges count, and what the scan cannot tell is said. Everything is computed in this browser, also without a network:":"\xD6ffnen Sie den Laserscan eines Ortes und klicken Sie, um zu fragen. B\xE4ume, Balkone und Br\xFCcken z\xE4hlen mit, und was der Scan nicht zeigen kann, wird gesagt. Alles wird in diesem Browser berechnet, auch ohne Internetverbindung:","Open a point cloud":"Eine Punktwolke \xF6ffnen","Open a simulated town":"Eine simulierte Stadt \xF6ffnen","Open another file":"Eine andere Datei \xF6ffnen","Open this part":"Diesen Ausschnitt \xF6ffnen",Orbit:"Kreisen","Orbit: drag to turn, right drag to move, wheel to zoom.":"Umkreisen: Ziehen dreht, Ziehen mit der rechten Maustaste verschiebt, das Mausrad zoomt.","Orbit: one finger turns, two fingers move and zoom.":"Umkreisen: Ein Finger dreht, zwei Finger verschieben und zoomen.","Own colours":"Eigene Farben","Panorama from north to north: sky blue, near dark, far light":"Panorama von Nord bis Nord: Himmel blau, Nahes dunkel, Fernes hell","Panorama of distances around the place, north at both ends":"Panorama der Entfernungen rund um die Stelle, Norden an beiden Enden",Pause:"Pause",Picture:"Bild",Place:"Stelle",Plain:"Einfarbig",Plan:"Plan","Plan buildings":"Geb\xE4ude planen","Plan of the visible space at the height of the eye":"Grundriss des sichtbaren Raums in Augenh\xF6he","Plan of the visible space, {0} square metres":"Grundriss des sichtbaren Raums, {0} Quadratmeter",Plane:"Dachfl\xE4che","Plane of the roof":"Dachfl\xE4che",Play:"Abspielen","Play the day":"Den Tag abspielen","Play the day (Space)":"Den Tag abspielen (Leertaste)","Point cloud. Arrow keys turn the view, plus and minus zoom, Enter asks the selected question at the centre. Press ? for all keys.":"Punktwolke. Pfeiltasten drehen die Ansicht, Plus und Minus zoomen, Enter stellt die gew\xE4hlte Frage f\xFCr die Bildmitte. Dr\xFCcken Sie ? f\xFCr alle Tasten.",Points:"Punkte",Preparing:"Vorbereitung","Preparing: {0}":"Vorbereitung: {0}","Probability that B is visible":"Wahrscheinlichkeit, dass B sichtbar ist","Profile of the line of sight":"Profil der Sichtlinie",Questions:"Fragen","Questions are now answered with the plan. Before, after and change are at the top (V).":"Fragen werden jetzt mit dem Plan beantwortet. Vorher, Nachher und \xC4nderung stehen oben (V).","Received by a square metre":"Empfangen pro Quadratmeter","Reference system, where the file names none":"Bezugssystem, falls die Datei keines nennt",Remove:"Entfernen","Remove {0}":"{0} entfernen","Right (D)":"Nach rechts (D)",Roof:"Dach",S:"S","Save a picture":"Bild speichern","Save a picture (P)":"Bild speichern (P)","Save {0}":"{0} speichern",Seen:"Sicht","Seen from":"Einsehbar","Seen from {0} m\xB2":"Zu sehen von {0} m\xB2",Shadow:"Schatten","Shadow at a time":"Schatten zur Uhrzeit","Share of possible sun":"Anteil an der m\xF6glichen Sonne","Show a part":"Ausschnitt zeigen","Show a part of the points (X)":"Einen Ausschnitt der Punkte zeigen (X)","Show all":"Alles zeigen","Show all of it (H)":"Alles zeigen (H)","Show edges of roofs, ridges and walls as they were found (O)":"Dachkanten, Firste und W\xE4nde zeigen, wie sie gefunden wurden (O)","Show how sure each answer is":"Zeigen, wie sicher Antworten sind","Show the balls that block lines of sight (B)":"Die Kugeln zeigen, die Sichtlinien versperren (B)","Show the meshes beside the cloud":"Die 3D-Modelle zus\xE4tzlich zur Punktwolke zeigen","Shows a part of the points alone: between two heights, and, after two clicks, between these corners on the map. Answers still count all of them.":"Zeigt nur einen Teil der Punkte: zwischen zwei H\xF6hen und, nach zwei Klicks, zwischen diesen Ecken auf der Karte. Antworten ber\xFCcksichtigen weiterhin alle Punkte.",Sky:"Himmel","Sky and space here":"Himmel und Raum hier","Sky openness":"Himmelsoffenheit","Sky view factor {0}":"Himmelssichtfaktor {0}",Slope:"Neigung","Solar energy of a roof":"Solarenergie, Dach","Solar energy received in each month":"Empfangene Sonnenenergie in jedem Monat","Solar energy received in each month, kWh/m\xB2":"Empfangene Sonnenenergie in jedem Monat, kWh/m\xB2",Solid:"Dicht",Space:"Leertaste","Start again":"Neu beginnen","Stored in this file.":"In dieser Datei gespeichert.",Sun:"Sonne","Sun here":"Sonne hier","Sun hours":"Sonnendauer","Sun hours of an area":"Sonnenstunden, Fl\xE4che",Table:"Tabelle","Tap anywhere to ask":"Tippen Sie irgendwohin, um zu fragen","The answer comes as soon as the scene is ready.":"Die Antwort kommt, sobald die Szene bereit ist.","The catalogue has {0} tiles. Choose the part to open: {1} by {2}, in the unit of the files.":"Der Katalog hat {0} Kacheln. W\xE4hlen Sie den Teil, der ge\xF6ffnet werden soll: {1} mal {2}, in der Einheit der Dateien.","The connection to Belvedere is lost. Is the program still running?":"Die Verbindung zu Belvedere ist unterbrochen. L\xE4uft das Programm noch?","The date is missing":"Das Datum fehlt","The files from above, and the part to open. Arrow keys move it.":"Die Dateien von oben und der Ausschnitt, der ge\xF6ffnet werden soll. Pfeiltasten verschieben ihn.","The files have {0} million points, and this browser has room for {1} million. Choose the part to open: {2} by {3}, in the unit of the file.":"Die Dateien haben {0} Millionen Punkte, und dieser Browser hat Platz f\xFCr {1} Millionen. W\xE4hlen Sie den Ausschnitt, der ge\xF6ffnet werden soll: {2} mal {3}, in der Einheit der Datei.","The line meets a surface of the survey ({0}) {1} from A.":"Die Linie trifft {1} von A entfernt auf eine vermessene Fl\xE4che ({0}).","The line meets an obstacle {0} from A.":"Die Linie trifft {0} von A entfernt auf ein Hindernis.","The location is unknown":"Die Lage ist unbekannt","The same on the command line":"Dasselbe in der Befehlszeile","The scene is lost: this tab has run out of memory, or Belvedere failed. Open the file again, or a smaller part of it.":"Die Szene ist verloren: Diesem Tab ist der Arbeitsspeicher ausgegangen, oder Belvedere ist abgest\xFCrzt. \xD6ffnen Sie die Datei noch einmal oder nur einen kleineren Ausschnitt davon.","The scene on the command line":"Die Szene in der Befehlszeile","The server answers with {0}.":"Der Server antwortet mit {0}.","The sun is below the horizon":"Die Sonne steht unter dem Horizont","The sun needs to know where on earth the cloud lies, but its file names no reference system. Open it again with the reference system of the cloud.":"F\xFCr die Sonne muss bekannt sein, wo auf der Erde die Punktwolke liegt, aber ihre Datei nennt kein Bezugssystem. \xD6ffnen Sie die Datei noch einmal und geben Sie das Bezugssystem der Punktwolke an.","The sun on {0} over the horizon of the place":"Die Sonne am {0} \xFCber dem Horizont der Stelle","The time zone is missing":"Die Zeitzone fehlt","The window needs four numbers: west, south, east, north.":"Der Ausschnitt braucht vier Zahlen: West, S\xFCd, Ost, Nord.","There is no point of the cloud at this place. Click on a point.":"An dieser Stelle liegt kein Punkt der Punktwolke. Klicken Sie auf einen Punkt.","This browser has no WebGL 2, which the page needs. Try another browser, or switch on hardware acceleration.":"Dieser Browser hat kein WebGL 2, das diese Seite braucht. Versuchen Sie es mit einem anderen Browser oder schalten Sie die Hardwarebeschleunigung ein.","This help":"Diese Hilfe","This is now, by the clocks of the place.":"Gezeigt wird die jetzige Uhrzeit an diesem Ort.","This question is about all points. It needs no click.":"Diese Frage betrifft alle Punkte. Sie braucht keinen Klick.",Tilt:"Neigung",Time:"Zeit","Time zone":"Zeitzone","Times are those of {0}: {1}.":"Uhrzeiten gelten in der Zeitzone {0}: {1}.",Trees:"B\xE4ume","Try again":"Erneut versuchen",Turn:"Drehen","Unproven length":"Unbewiesene L\xE4nge","Up (E)":"Aufw\xE4rts (E)",View:"Ansicht",Viewpoint:"Standpunkt","Viewpoint {0}":"Standpunkt {0}","Visible area in plan":"Sichtbare Fl\xE4che im Grundriss","Visible volume up to obstacles":"Sichtbares Volumen bis zu Hindernissen",W:"W",Walk:"Gehen","Walk: eyes 1.7 m above the ground. Fly: you go where you look. The arrows at the right go ahead, aside and back; drag to look around.":"Gehen: Augen 1,7 m \xFCber dem Boden. Fliegen: Sie bewegen sich dorthin, wohin Sie blicken. Die Pfeile rechts f\xFChren vorw\xE4rts, zur Seite und zur\xFCck; ziehen Sie, um sich umzusehen.","Way of moving":"Art der Bewegung","What is seen from here":"Was man von hier sieht","What is visible from here?":"Was ist von hier zu sehen?","What lies in shadow?":"Was liegt im Schatten?","What the plan changes":"Was der Plan \xE4ndert","Where few points tell of a surface, a place on it may lie just inside it: ask again from higher above the clicked point.":"Wo nur wenige Punkte eine Oberfl\xE4che zeigen, kann eine Stelle darauf knapp in ihrem Inneren liegen: Fragen Sie noch einmal mit einer gr\xF6\xDFeren H\xF6he \xFCber dem angeklickten Punkt.","Which part?":"Welcher Ausschnitt?","Who sees this":"Von wo man das sieht","Whole scene":"Alles","Window: west, south, east, north in the coordinates of the file":"Ausschnitt: West, S\xFCd, Ost, Nord in den Koordinaten der Datei","With open directions, up to {0} m":"Mit offenen Richtungen, bis {0} m","Without any shade":"Ohne jeden Schatten","Write one below, such as Europe/Amsterdam or +02:00.":"Geben Sie unten eine an, zum Beispiel Europe/Amsterdam oder +02:00.",Zoom:"Zoomen","about {0}":"etwa {0}","all of it":"alles",azimuth:"Azimut","ball file":"Kugeldatei",blocked:"verdeckt","blocked here":"hier verdeckt",bridge:"Br\xFCcke",building:"Geb\xE4ude","by the longitude of the place, without summer time: look whether it is right":"nach der geografischen L\xE4nge des Ortes, ohne Sommerzeit; pr\xFCfen Sie, ob sie stimmt","by the plan, of {0} points of the cloud.":"durch den Plan, von {0} Punkten der Punktwolke.","civil structure":"Ingenieurbauwerk","class {0}":"Klasse {0}","edge of a roof":"Dachkante",feet:"Fu\xDF","from {0} to {1}, of {2} points of the cloud.":"von {0} bis {1}, von {2} Punkten der Punktwolke.",ground:"Boden","high noise":"Rauschen (hoch)","high vegetation":"hohe Vegetation","horizon; dashed: 21 June, March, December":"Horizont; gestrichelt: 21. Juni, M\xE4rz, Dezember","in shadow":"im Schatten","in shadow at both times":"zu beiden Zeiten im Schatten","in shadow before and after":"vorher und nachher im Schatten","inside an obstacle":"in einem Hindernis","inside of a building":"Inneres eines Geb\xE4udes","is the solar energy received by {0} m\xB2 of panels from sun and sky, not electricity: panels turn a part of it into that. It is for a sky without clouds, an upper bound. With a file of weather, the command below gives less.":"Sonnenenergie empfangen {0} m\xB2 Solarmodule von Sonne und Himmel. Das ist noch kein Strom: Die Module wandeln einen Teil davon in Strom um. Der Wert gilt f\xFCr einen Himmel ohne Wolken und ist eine Obergrenze. Mit einer Wetterdatei ergibt der Befehl unten weniger.","known to {0} cm (standard deviation)":"auf {0} cm bekannt (Standardabweichung)",lit:"besonnt","lit at both times":"zu beiden Zeiten besonnt","lit before and after":"vorher und nachher besonnt","lit only after":"nur nachher besonnt","lit only at the first time":"nur zur ersten Zeit besonnt","lit only at the second time":"nur zur zweiten Zeit besonnt","lit only before":"nur vorher besonnt","lit with a probability of {0} %":"mit {0} % Wahrscheinlichkeit besonnt","lit, unproven":"besonnt, unbewiesen","low noise":"Rauschen (tief)","low vegetation":"niedrige Vegetation","m high":"m hoch","medium vegetation":"mittlere Vegetation",metres:"Meter","metres, unless the file says otherwise":"Meter, wenn die Datei nichts anderes sagt",millimetres:"Millimeter","never classified":"nie klassifiziert","no answer":"keine Antwort",none:"keine","not visible before and after":"vorher und nachher nicht sichtbar","nothing leaves this computer":"Nichts verl\xE4sst diesen Computer","of ground, by eyes 1.7 m above it.":"Boden aus, mit Augen 1,7 m dar\xFCber.","of the points of the cloud, {0}.":"von allen Punkten der Punktwolke, {0}.","of the points of the cloud.":"von allen Punkten der Punktwolke.","on average on {0}, of {1} possible hours.":"im Durchschnitt am {0}, von {1} m\xF6glichen Stunden.","on average on {0}, on the ground that is free before and after.":"im Durchschnitt am {0}, auf dem Boden, der vorher und nachher frei ist.","on {0}, of {1} hours between sunrise and sunset.":"am {0}, von {1} Stunden zwischen Sonnenaufgang und Sonnenuntergang.","or drop them here":"oder hier ablegen","outside the cloud":"au\xDFerhalb der Punktwolke",parapet:"Br\xFCstung",pylon:"Mast",rail:"Gleis","ridge or valley":"First oder Kehle","road surface":"Stra\xDFenoberfl\xE4che",roof:"Dach","scale bar":"Ma\xDFstabsbalken",slope:"Neigung","step of a roof":"Stufe im Dach",strong:"stark","structure on a roof":"Dachaufbau","that of the place":"die des Ortes","that of the place; a border with other clocks is near, so look whether it is right":"die des Ortes; eine Zeitzonengrenze ist in der N\xE4he, pr\xFCfen Sie daher, ob sie stimmt","this computer's":"die dieses Computers","this computer's, which fits the place":"die dieses Computers, die zum Ort passt","this computer's, which fits the place; a border with other clocks is near, so look whether it is right":"die dieses Computers, die zum Ort passt; eine Zeitzonengrenze ist in der N\xE4he, pr\xFCfen Sie daher, ob sie stimmt","this computer's, which may fit the place":"die dieses Computers, die zum Ort passen k\xF6nnte",unclassified:"nicht klassifiziert",unproven:"unbewiesen",up:"nach oben",upright:"senkrecht",visible:"sichtbar","visible before and after":"vorher und nachher sichtbar","visible only after":"nur nachher sichtbar","visible only before":"nur vorher sichtbar",wall:"Wand",water:"Wasser",weak:"schwach",wire:"Leitung","{0} % sure":"Zu {0} % sicher","{0} corners.":"{0} Ecken.","{0} hours of sun":"{0} Sonnenstunden","{0} is lit":"{0} sind besonnt","{0} is visible":"{0} sind sichtbar","{0} kWh a year":"{0} kWh pro Jahr","{0} of {1}":"{0} von {1}","{0} of {1} m":"{0} zu je {1} m","{0} of {1} points drawn":"{0} von {1} Punkten gezeichnet","{0} points":"{0} Punkte","{0} points are hidden":"{0} Punkte werden verdeckt","{0} points come into view":"{0} Punkte werden sichtbar","{0} points gain the sun":"{0} Punkte gewinnen Sonne","{0} points lose the sun":"{0} Punkte verlieren Sonne","{0} scenes are kept in this browser ({1} MB): the same files open in a moment.":"{0} Szenen sind in diesem Browser gespeichert ({1} MB): Dieselben Dateien \xF6ffnen sich sofort.","{0} to {1}":"{0} bis {1}","{0}, shown":"{0}, angezeigt","{0}, which scatter by {1} cm":"{0}, mit einer Streuung von {1} cm","{0}\xB0 from north":"{0}\xB0 von Nord"},stages:{reading:"Lesen",cleaning:"Bereinigen","estimating scanner positions":"Scannerpositionen sch\xE4tzen","indexing pulses":"Laserpulse indizieren","grouping pulses":"Laserpulse gruppieren","indexing points":"Punkte indizieren","estimating normals":"Normalen sch\xE4tzen","orienting normals":"Normalen ausrichten","measuring crowns":"Baumkronen vermessen","marking crowns":"Baumkronen markieren","finding vegetation":"Vegetation erkennen","finding thin objects":"D\xFCnne Objekte erkennen","finding thin surfaces":"D\xFCnne Fl\xE4chen erkennen","shrinking balls":"Kugeln schrumpfen","carving balls":"Kugeln mit Laserpulsen zuschneiden","cutting at roof edges":"An Dachkanten schneiden","cutting at data voids":"An Datenl\xFCcken schneiden","finding thin relief":"Schmale Erhebungen erkennen","pruning balls":"\xDCberfl\xFCssige Kugeln entfernen",filling:"Auff\xFCllen","finding roofs and walls":"D\xE4cher und W\xE4nde erkennen","capping balls":"Kugeln begrenzen","indexing balls":"Kugeln indizieren","checking pulses":"Laserpulse pr\xFCfen","keeping scene":"Szene speichern","reading kept scene":"Gespeicherte Szene lesen","closing floors below tripods":"B\xF6den unter Stativen schlie\xDFen"},remarks:{"targets-near-edge":"{count} von {of} Zielpunkten ({percent} %) liegen nahe am Rand der Punktwolke: Objekte jenseits davon, so hoch wie ihr h\xF6chster Punkt, k\xF6nnten ihnen Sonne oder Himmel nehmen","light-unproven":"{count} von {of} besonnten Zielpunkten ({percent} %) sind besonnt, soweit die Punkte es zeigen, aber kein Laserpuls beweist, dass ihr Weg zur Sonne frei ist","suns-below-horizon":"{count} von {of} Sonnenst\xE4nden ({percent} %) liegen unter dem Horizont: Nichts ist besonnt","ground-not-believed":"{count} von {of} Punkten der Klasse 2 ({percent} %) liegen mehrere Meter unter oder \xFCber dem Boden ringsum und gelten nicht als Boden","targets-inside-obstacle":"{count} von {of} Zielpunkten ({percent} %) liegen in einem Hindernis, oder ihr Auge liegt darin: Sie sind weder sichtbar noch verdeckt","probability-from-the-ground":"der Scanner stand am Boden: Wahrscheinlichkeiten f\xFCr das, was er nicht sah, etwa D\xE4cher und abgewandte W\xE4nde, k\xF6nnen um ein Viertel falsch sein","no-roofs":"es wurde kein Dach gefunden: D\xE4cher zeigen sich an Punkten der Klasse 6 oder, wo es keine gibt, an Einzelechos der Klassen 0 und 1, die \xFCber Punkten der Klasse 2 liegen; klassifizieren Sie die Punkte zuerst, falls es Geb\xE4ude gibt","nothing-cleared":"dort steht nichts, was ger\xE4umt werden k\xF6nnte","small-roof-planes":"{count} Dachfl\xE4chen ({area_m2} m\xB2) sind zu klein f\xFCr Solarmodule und werden nicht aufgef\xFChrt","end-inside-obstacle":"die Stelle liegt in einem Hindernis, {depth_m} m tief: Von dort sieht man nichts, und sie ist von nirgends zu sehen; geben Sie eine Stelle au\xDFerhalb an","true-north-unknown":"Azimute z\xE4hlen ab Gitternord, weil die geografische Nordrichtung unbekannt ist: Die Szene hat kein brauchbares Bezugssystem (EPSG-Code oder WKT)","y-looks-up":"in dieser Punktwolke scheint y nach oben zu zeigen, nicht z: Ihre ebenen Fl\xE4chen sind nach y gerichtet","unit-of-room":"diese Punktwolke sieht aus wie ein Raum in Millimetern oder Zentimetern und wurde in Metern gelesen: W\xE4hlen Sie die Einheit"},refusals:{"This place is outside the cloud, where nothing is known.":"Dieser Ort liegt au\xDFerhalb der Punktwolke, wo nichts bekannt ist.","A and B are the same place: click two different ones.":"A und B sind derselbe Ort: Klicken Sie auf zwei verschiedene.","An area needs at least three corners.":"Eine Fl\xE4che braucht mindestens drei Ecken.","A building or an area needs at least three corners.":"Ein Geb\xE4ude oder eine Fl\xE4che braucht mindestens drei Ecken.","A building needs a height above 0 m.":"Ein Geb\xE4ude braucht eine H\xF6he \xFCber 0 m.","There is no sun at this time.":"Zu dieser Zeit scheint keine Sonne.","Nobody can look from this place.":"Von diesem Ort aus kann niemand sehen.","The plan is not kept any more: change it, or load the page again.":"Der Plan ist nicht mehr vorhanden: \xC4ndern Sie ihn, oder laden Sie die Seite neu.","The mesh is not kept any more: load it again.":"Das 3D-Modell ist nicht mehr vorhanden: Laden Sie es noch einmal.","There is no plane of a roof here: click a roof of at least 4 m\xB2.":"Hier ist keine Dachfl\xE4che: Klicken Sie auf ein Dach von mindestens 4 m\xB2.","Meshes, rasters and shapes are shown with a cloud: choose one too.":"3D-Modelle, Raster und Formen werden mit einer Punktwolke gezeigt: W\xE4hlen Sie auch eine."}};var Wh={texts:{"1 corner.":"1\xA0coin.","1 scene is kept in this browser ({0} MB): the same files open in a moment.":"1\xA0sc\xE8ne est conserv\xE9e dans ce navigateur ({0}\xA0Mo)\xA0: les m\xEAmes fichiers s\u2019ouvrent en un instant.","1 under a free sky, 0 without any sky.":"1 sous un ciel d\xE9gag\xE9, 0 sans aucun ciel visible.","A file on the web, a reference system, a part of a file":"Un fichier sur le web, un syst\xE8me de r\xE9f\xE9rence, une partie d\u2019un fichier","A first answer from a sample of them; the exact one follows \u2026":"Premi\xE8re r\xE9ponse, d\u2019apr\xE8s un \xE9chantillon de ces points\xA0; la r\xE9ponse exacte suit\u2026","A first answer from a sample of {0} points; the exact one follows \u2026":"Premi\xE8re r\xE9ponse, d\u2019apr\xE8s un \xE9chantillon de {0} points\xA0; la r\xE9ponse exacte suit\u2026","A to B":"De A \xE0 B",About:"Environ","Address of a file on the web, or of a catalogue of tiles (.vpc, STAC); of COPC, only the part that is opened is transferred":"Adresse d\u2019un fichier sur le web, ou d\u2019un catalogue de dalles (.vpc, STAC)\xA0; d\u2019un COPC, seule la partie ouverte est transf\xE9r\xE9e",After:"Apr\xE8s","Ahead (W)":"En avant (W)",Answer:"R\xE9ponse","Answered in {0} ms.":"R\xE9ponse en {0}\xA0ms.","Answers before or after the plan, or the change":"R\xE9ponses avant ou apr\xE8s le projet, ou le changement","Area in its plane":"Surface dans son plan","Area of the plane":"Surface du pan","Area on the map":"Surface sur la carte","As measured":"Selon la mesure",Ask:"Poser la question","Ask about this place":"Questions sur cet endroit","Ask at the centre of the view":"Poser la question au centre de la vue","Asking \u2026":"Calcul de la r\xE9ponse\u2026","At least three corners are needed.":"Il faut au moins trois coins.","At the time below":"\xC0 l\u2019heure ci-dessous","Axis that is up":"Axe dirig\xE9 vers le haut","Azimuth of the sun":"Azimut du soleil","B is blocked":"B est masqu\xE9","B is unproven":"Visibilit\xE9 de B non prouv\xE9e","B is visible from A":"B est visible depuis A","Back (S)":"En arri\xE8re (S)",Balls:"Boules",Before:"Avant","Before, after, change of a plan":"Projet\xA0: avant, apr\xE8s, changement","Between the two times":"Entre les deux moments","Blocked after":"Vue masqu\xE9e apr\xE8s","Blocked at":"Vue masqu\xE9e au point","Building {0}":"B\xE2timent {0}",Cancel:"Annuler",Cells:"Cellules",Change:"Changement","Change of the hours of sun":"Variation des heures d\u2019ensoleillement","Changing the scene \u2026":"Modification de la sc\xE8ne\u2026","Choose a day below.":"Choisissez un jour ci-dessous.","Choose a question":"Choisir une question","Choose a question on the left, then click a place. Every answer is computed by the program on this computer, and shows the command that gives the same.":"Choisissez une question \xE0 gauche, puis cliquez sur un endroit. Chaque r\xE9ponse est calcul\xE9e par le programme sur cet ordinateur et indique la commande qui donne le m\xEAme r\xE9sultat.","Choose a question on the left. This file holds the answers that were computed when it was made, each with the command that gives the same.":"Choisissez une question \xE0 gauche. Ce fichier contient les r\xE9ponses calcul\xE9es lors de sa cr\xE9ation, chacune avec la commande qui donne le m\xEAme r\xE9sultat.","Choose a viewpoint: its view is in this file.":"Choisissez un point de vue\xA0: la vue correspondante est dans ce fichier.","Choose another date or time below.":"Choisissez ci-dessous une autre date ou une autre heure.","Choose files":"Choisissez des fichiers","Choose the files again: they are read as chosen below.":"Choisissez de nouveau les fichiers : ils sont lus selon les choix ci-dessous.",Class:"Classe","Clear an area":"D\xE9gager une zone","Cleared area {0}":"Zone d\xE9gag\xE9e {0}","Click A, where the eye is, then B.":"Cliquez sur A, o\xF9 se trouve l\u2019\u0153il, puis sur B.","Click a place to measure its sky view and the space that is visible from it.":"Cliquez sur un endroit pour mesurer la part de ciel et l\u2019espace que l\u2019on voit de l\xE0.","Click a place to see when the sun reaches it.":"Cliquez sur un endroit pour voir quand le soleil l\u2019atteint.","Click a roof to see what sun and sky send to its plane in a year of clear sky.":"Cliquez sur un toit pour voir ce que son pan re\xE7oit du soleil et du ciel en une ann\xE9e de ciel d\xE9gag\xE9.","Click a target to see from where people can see it.":"Cliquez sur une cible pour savoir d\u2019o\xF9 on peut la voir.","Click anywhere to ask":"Cliquez o\xF9 vous voulez","Click around what shall go, such as a tree or a house.":"Entourez par des clics ce qui doit dispara\xEEtre, par exemple un arbre ou une maison.","Click more places for a longer line or an area.":"Cliquez sur d\u2019autres endroits pour une ligne plus longue ou une surface.","Click more, or go on with these.":"Cliquez sur d\u2019autres coins ou continuez avec ceux-ci.","Click more.":"Cliquez sur d\u2019autres coins.","Click places to measure between them.":"Cliquez sur plusieurs endroits pour mesurer entre eux.","Click the corners of the area.":"Cliquez sur les coins de la zone.","Click the corners of the building.":"Cliquez sur les coins du b\xE2timent.","Click the opposite corner.":"Cliquez sur le coin oppos\xE9.","Click two corners, or move the heights.":"Cliquez sur deux coins ou r\xE9glez les hauteurs.","Click two places for a length, more for an area.":"Cliquez sur deux endroits pour une longueur, sur davantage pour une surface.","Click where somebody stands: ground, balcony or roof.":"Cliquez l\xE0 o\xF9 quelqu\u2019un se tient\xA0: sol, balcon ou toit.",Close:"Fermer","Close the answer":"Fermer la r\xE9ponse",Colour:"Couleur","Colour of the points":"Couleur des points","Compare no longer":"Ne plus comparer","Compare this time with another":"Comparer ce moment avec un autre","Coordinates under the pointer":"Coordonn\xE9es sous le pointeur",Copied:"Copi\xE9","Copy command":"Copier la commande",Cut:"Extrait",Dark:"Sombre",Date:"Date","Date and time":"Date et heure","Read it again":"Relire","Read it with y up":"Lire avec y vers le haut","Read it with z up":"Lire avec z vers le haut","Reference system":"Syst\xE8me de r\xE9f\xE9rence","Share of open directions":"Part des directions ouvertes",Size:"Taille","The cloud, and how it is read":"Le nuage et sa lecture","Times are those of {0}.":"Les heures sont celles du fuseau {0}.","To read it with another reference system or up axis, end the program and start it with --crs or --up.":"Pour un autre syst\xE8me de r\xE9f\xE9rence ou un autre axe vertical, quittez le programme et relancez-le avec --crs ou --up.","Unit, where the file names none":"Unit\xE9, si le fichier n\u2019en nomme pas","Unit, which the files do not name":"Unit\xE9, que les fichiers ne nomment pas",centimetres:"centim\xE8tres","deck, canopy or balcony":"tablier, auvent ou balcon","Down (Q)":"Vers le bas (Q)","Drag to turn, right drag to move, wheel to zoom. Click a point for its coordinates.":"Glissez pour tourner, glissez avec le bouton droit pour d\xE9placer la vue, molette pour zoomer. Cliquez sur un point pour voir ses coordonn\xE9es.","Draw a building":"Dessiner un b\xE2timent","Draw or load what is planned, clear what goes; then ask again.":"Dessinez ou chargez ce qui est pr\xE9vu, d\xE9gagez ce qui dispara\xEEt\xA0; puis reposez vos questions.",E:"E","Earlier or later":"Plus t\xF4t ou plus tard",Edges:"Ar\xEAtes","Elevation of the sun":"Hauteur du soleil","Eye above A":"Yeux au-dessus de A","Eye above the clicked point":"Yeux au-dessus du point cliqu\xE9",Faces:"Orientation","Farthest view in plan":"Vue la plus lointaine en plan",Finish:"Terminer","First light":"Premier rayon",Fly:"Vol",Forget:"Oublier","From above":"De dessus","From the clicked place":"Depuis l\u2019endroit cliqu\xE9","From viewpoint {0}":"Depuis le point de vue {0}","From where the place is seen":"D\u2019o\xF9 l\u2019endroit est visible","From {0} cells nothing is in the way, but no pulse proves it.":"Depuis {0} cellules, rien ne fait obstacle, mais aucune impulsion laser ne le prouve.","Gains sun":"Gagne du soleil",Go:"Se d\xE9placer","Go ahead":"Avancer","Go back":"Reculer","Go down":"Descendre","Go left":"Aller \xE0 gauche","Go right":"Aller \xE0 droite","Go up":"Monter","Greatest gain":"Gain maximal","Greatest loss":"Perte maximale","Ground (brown), obstacles (grey) and the line of sight":"Sol (brun), obstacles (gris) et ligne de vis\xE9e","Ground in the area":"Sol dans la zone",Height:"Altitude","Height above the clicked point":"Hauteur au-dessus du point cliqu\xE9","Height of building {0} in metres":"Hauteur du b\xE2timent {0} en m\xE8tres","Height of the building":"Hauteur du b\xE2timent","Height of the last above the first":"D\xE9nivel\xE9 du premier au dernier",Help:"Aide","Hours of sun on the 21st of each month":"Heures d\u2019ensoleillement le 21 de chaque mois","Hours of sun on the day":"Heures d\u2019ensoleillement ce jour-l\xE0","How likely it is lit":"Probabilit\xE9 d\u2019\xEAtre au soleil","How likely it is visible":"Probabilit\xE9 d\u2019\xEAtre visible","In nine of ten cases":"Dans neuf cas sur dix",Intensity:"Intensit\xE9","Is B seen from A":"B visible depuis A","It is {0} there now, and the sun is down or near the horizon: this is noon, when it stands highest.":"Il est actuellement {0} sur place, et le soleil est couch\xE9 ou proche de l\u2019horizon\xA0: l\u2019heure affich\xE9e est celle du midi solaire, quand il est au plus haut.","Its height":"Sa hauteur","Its points":"Ses points","Keys and help (?)":"Touches et aide (?)","LAZ, LAS, COPC, E57, PLY, PCD, PTX, text; with them models and maps: OBJ, CityJSON, GeoTIFF, GeoJSON":"LAZ, LAS, COPC, E57, PLY, PCD, PTX, texte\xA0; avec eux mod\xE8les et cartes\xA0: OBJ, CityJSON, GeoTIFF, GeoJSON",Language:"Langue","Last light":"Dernier rayon",Least:"Minimum","Left (A)":"\xC0 gauche (A)",Legend:"L\xE9gende",Length:"Longueur","Length of the line":"Longueur de la ligne","Length on the map":"Longueur sur la carte","Less sure, or unproven":"Moins s\xFBr, ou non prouv\xE9","Let light through":"Laissent passer la lumi\xE8re",Light:"Clair","Light or dark":"Clair ou sombre","Light or dark (L)":"Clair ou sombre (L)","Lit, but unproven":"Au soleil, mais non prouv\xE9","Load a mesh":"Charger un maillage","Longest stretch":"Plus longue p\xE9riode au soleil",Look:"Explorer","Look around":"Explorer la sc\xE8ne","Look straight down, north up (T)":"Regarder \xE0 la verticale, nord en haut (T)","Loses sun":"Perd du soleil","Lost by shade, each panel for itself":"Perte due \xE0 l\u2019ombre, panneaux ind\xE9pendants","Lost by shade, panels in strings":"Perte due \xE0 l\u2019ombre, panneaux en s\xE9rie",Map:"Carte",Measure:"Mesurer","Measure lengths, heights and areas (R)":"Mesurer des longueurs, des hauteurs et des surfaces (R)","Mesh file":"Fichier de maillage",Meshes:"Maillages",Most:"Maximum",Move:"Mode","Move the time, or play the day.":"Changez l\u2019heure ou animez la journ\xE9e.","Move; down and up":"Se d\xE9placer\xA0; descendre et monter",N:"N","Nearest obstacle in plan":"Obstacle le plus proche en plan","Next colour":"Couleur suivante","Next way of moving":"Mode de d\xE9placement suivant","No answer":"Pas de r\xE9ponse","No answer: A or B is inside an obstacle":"Pas de r\xE9ponse\xA0: A ou B est \xE0 l\u2019int\xE9rieur d\u2019un obstacle","No answer: outside the cloud":"Pas de r\xE9ponse\xA0: hors du nuage","No ground is known that sees it":"Visible d\u2019aucun endroit connu au sol","No scan at hand?":"Pas de relev\xE9 sous la main\xA0?","No tile of the catalogue lies there.":"Aucune dalle du catalogue ne s\u2019y trouve.","Not above":"Pas au-dessus de","Not below":"Pas au-dessous de","Nothing blocks what is unproven, but part of the line runs through space that no laser pulse has seen.":"Rien ne masque ce qui est non prouv\xE9, mais une partie de la ligne de vis\xE9e traverse un espace qu\u2019aucune impulsion laser n\u2019a parcouru.","Nothing stands in the line.":"Rien ne fait obstacle sur la ligne de vis\xE9e.","Now click B.":"Cliquez maintenant sur B.","One finger turns, two fingers move and zoom. Tap a point for its coordinates.":"Un doigt pour tourner, deux doigts pour d\xE9placer la vue et zoomer. Touchez un point pour voir ses coordonn\xE9es.",Open:"Ouvrir","Open a laser scan of a place, and click to ask. Trees, balconies and bridges count, and what the scan cannot tell is said. Everything is computed in this browser, also without a network:":"Ouvrez le relev\xE9 laser d\u2019un lieu, puis cliquez pour poser vos questions. Les arbres, les balcons et les ponts sont pris en compte, et ce que le relev\xE9 ne permet pas de savoir est indiqu\xE9. Tout est calcul\xE9 dans ce navigateur, m\xEAme sans r\xE9seau\xA0:","Open a point cloud":"Ouvrir un nuage de points","Open a simulated town":"Ouvrir une ville simul\xE9e","Open another file":"Ouvrir un autre fichier","Open this part":"Ouvrir cette partie",Orbit:"Orbite","Orbit: drag to turn, right drag to move, wheel to zoom.":"Orbite\xA0: glissez pour tourner, glissez avec le bouton droit pour d\xE9placer la vue, molette pour zoomer.","Orbit: one finger turns, two fingers move and zoom.":"Orbite\xA0: un doigt pour tourner, deux doigts pour d\xE9placer la vue et zoomer.","Own colours":"Couleurs d\u2019origine","Panorama from north to north: sky blue, near dark, far light":"Panorama du nord au nord\xA0: ciel en bleu, proche en fonc\xE9, lointain en clair","Panorama of distances around the place, north at both ends":"Panorama des distances autour de l\u2019endroit, le nord aux deux extr\xE9mit\xE9s",Pause:"Pause",Picture:"Image",Place:"Emplacement",Plain:"Couleur unie",Plan:"Projet","Plan buildings":"Projet de construction","Plan of the visible space at the height of the eye":"Plan de l\u2019espace visible \xE0 hauteur des yeux","Plan of the visible space, {0} square metres":"Plan de l\u2019espace visible, {0}\xA0m\xE8tres carr\xE9s",Plane:"Pan","Plane of the roof":"Pan de toit",Play:"Lecture","Play the day":"Animer la journ\xE9e","Play the day (Space)":"Animer la journ\xE9e (Espace)","Point cloud. Arrow keys turn the view, plus and minus zoom, Enter asks the selected question at the centre. Press ? for all keys.":"Nuage de points. Les fl\xE8ches font tourner la vue, plus et moins r\xE8glent le zoom, Entr\xE9e pose la question choisie au centre. Appuyez sur\xA0? pour voir toutes les touches.",Points:"Points",Preparing:"Pr\xE9paration","Preparing: {0}":"Pr\xE9paration\xA0: {0}","Probability that B is visible":"Probabilit\xE9 que B soit visible","Profile of the line of sight":"Profil de la ligne de vis\xE9e",Questions:"Questions","Questions are now answered with the plan. Before, after and change are at the top (V).":"Les r\xE9ponses tiennent maintenant compte du projet. Avant, apr\xE8s et changement se choisissent en haut (V).","Received by a square metre":"Re\xE7u par m\xE8tre carr\xE9","Reference system, where the file names none":"Syst\xE8me de r\xE9f\xE9rence, si le fichier n\u2019en indique aucun",Remove:"Supprimer","Remove {0}":"Supprimer {0}","Right (D)":"\xC0 droite (D)",Roof:"Toit",S:"S","Save a picture":"Enregistrer une image","Save a picture (P)":"Enregistrer une image (P)","Save {0}":"Enregistrer {0}",Seen:"Visible","Seen from":"Vu depuis","Seen from {0} m\xB2":"Vu depuis {0}\xA0m\xB2",Shadow:"Ombre","Shadow at a time":"Ombre \xE0 une heure","Share of possible sun":"Part de l\u2019ensoleillement possible","Show a part":"Afficher une partie","Show a part of the points (X)":"Afficher une partie des points (X)","Show all":"Tout afficher","Show all of it (H)":"Afficher toute la sc\xE8ne (H)","Show edges of roofs, ridges and walls as they were found (O)":"Afficher les bords de toit, les fa\xEEtes et les murs tels qu\u2019ils ont \xE9t\xE9 trouv\xE9s (O)","Show how sure each answer is":"Afficher la certitude","Show the balls that block lines of sight (B)":"Afficher les boules qui coupent les lignes de vis\xE9e (B)","Show the meshes beside the cloud":"Afficher les maillages en plus du nuage","Shows a part of the points alone: between two heights, and, after two clicks, between these corners on the map. Answers still count all of them.":"Affiche seulement une partie des points\xA0: entre deux hauteurs et, apr\xE8s deux clics, entre ces coins sur la carte. Les r\xE9ponses tiennent toujours compte de tous les points.",Sky:"Ciel","Sky and space here":"Le ciel et l\u2019espace ici","Sky openness":"Ouverture du ciel","Sky view factor {0}":"Facteur de vue du ciel\xA0: {0}",Slope:"Pente","Solar energy of a roof":"\xC9nergie solaire d\u2019un toit","Solar energy received in each month":"\xC9nergie solaire re\xE7ue chaque mois","Solar energy received in each month, kWh/m\xB2":"\xC9nergie solaire re\xE7ue chaque mois, kWh/m\xB2",Solid:"Opaques",Space:"Espace","Start again":"Recommencer","Stored in this file.":"R\xE9ponse enregistr\xE9e dans ce fichier.",Sun:"Soleil","Sun here":"Le soleil ici","Sun hours":"h de soleil","Sun hours of an area":"Soleil d\u2019une zone",Table:"Tableau","Tap anywhere to ask":"Touchez o\xF9 vous voulez","The answer comes as soon as the scene is ready.":"La r\xE9ponse viendra d\xE8s que la sc\xE8ne sera pr\xEAte.","The catalogue has {0} tiles. Choose the part to open: {1} by {2}, in the unit of the files.":"Le catalogue compte {0} dalles. Choisissez la partie \xE0 ouvrir\xA0: {1} sur {2}, dans l\u2019unit\xE9 des fichiers.","The connection to Belvedere is lost. Is the program still running?":"La connexion \xE0 Belvedere est perdue. Le programme fonctionne-t-il encore\xA0?","The date is missing":"Il manque la date","The files from above, and the part to open. Arrow keys move it.":"Les fichiers vus de dessus, et la partie \xE0 ouvrir. Les fl\xE8ches la d\xE9placent.","The files have {0} million points, and this browser has room for {1} million. Choose the part to open: {2} by {3}, in the unit of the file.":"Les fichiers contiennent {0}\xA0millions de points, et ce navigateur peut en accueillir {1}\xA0millions. Choisissez la partie \xE0 ouvrir\xA0: {2} sur {3}, dans l\u2019unit\xE9 du fichier.","The line meets a surface of the survey ({0}) {1} from A.":"La ligne de vis\xE9e rencontre une surface du relev\xE9 ({0}) \xE0 {1} de A.","The line meets an obstacle {0} from A.":"La ligne de vis\xE9e rencontre un obstacle \xE0 {0} de A.","The location is unknown":"La position g\xE9ographique est inconnue","The same on the command line":"La m\xEAme chose en ligne de commande","The scene is lost: this tab has run out of memory, or Belvedere failed. Open the file again, or a smaller part of it.":"La sc\xE8ne est perdue\xA0: cet onglet n\u2019a plus de m\xE9moire, ou Belvedere a \xE9chou\xE9. Rouvrez le fichier, ou une plus petite partie de celui-ci.","The scene on the command line":"La sc\xE8ne en ligne de commande","The server answers with {0}.":"Le serveur r\xE9pond par {0}.","The sun is below the horizon":"Le soleil est sous l\u2019horizon","The sun needs to know where on earth the cloud lies, but its file names no reference system. Open it again with the reference system of the cloud.":"Pour calculer la position du soleil, il faut savoir o\xF9 se trouve le nuage sur la Terre, mais son fichier n\u2019indique aucun syst\xE8me de r\xE9f\xE9rence. Rouvrez-le en indiquant le syst\xE8me de r\xE9f\xE9rence du nuage.","The sun on {0} over the horizon of the place":"Le soleil le {0} au-dessus de l\u2019horizon de l\u2019endroit","The time zone is missing":"Il manque le fuseau horaire","The window needs four numbers: west, south, east, north.":"La fen\xEAtre demande quatre nombres\xA0: ouest, sud, est, nord.","There is no point of the cloud at this place. Click on a point.":"Il n\u2019y a aucun point du nuage \xE0 cet endroit. Cliquez sur un point.","This browser has no WebGL 2, which the page needs. Try another browser, or switch on hardware acceleration.":"Ce navigateur ne dispose pas de WebGL\xA02, dont la page a besoin. Essayez un autre navigateur ou activez l\u2019acc\xE9l\xE9ration mat\xE9rielle.","This help":"Cette aide","This is now, by the clocks of the place.":"L\u2019heure affich\xE9e est l\u2019heure actuelle sur place.","This question is about all points. It needs no click.":"Cette question porte sur tous les points. Il n\u2019est pas n\xE9cessaire de cliquer.",Tilt:"Inclinaison",Time:"Heure","Time zone":"Fuseau horaire","Times are those of {0}: {1}.":"Les heures sont celles du fuseau {0}\xA0: {1}.",Trees:"Arbres","Try again":"R\xE9essayer",Turn:"Tourner","Unproven length":"Longueur non prouv\xE9e","Up (E)":"Vers le haut (E)",View:"Vue",Viewpoint:"Point de vue","Viewpoint {0}":"Point de vue {0}","Visible area in plan":"Surface visible en plan","Visible volume up to obstacles":"Volume visible jusqu\u2019aux obstacles",W:"O",Walk:"Marche","Walk: eyes 1.7 m above the ground. Fly: you go where you look. The arrows at the right go ahead, aside and back; drag to look around.":"Marche\xA0: les yeux \xE0 1,7\xA0m au-dessus du sol. Vol\xA0: vous allez l\xE0 o\xF9 vous regardez. Les fl\xE8ches \xE0 droite servent \xE0 avancer, \xE0 aller de c\xF4t\xE9 et \xE0 reculer\xA0; glissez pour regarder autour de vous.","Way of moving":"Mode de d\xE9placement","What is seen from here":"Ce que l\u2019on voit d\u2019ici","What is visible from here?":"Que voit-on d\u2019ici\xA0?","What lies in shadow?":"Qu\u2019est-ce qui est \xE0 l\u2019ombre\xA0?","What the plan changes":"Ce que change le projet","Where few points tell of a surface, a place on it may lie just inside it: ask again from higher above the clicked point.":"L\xE0 o\xF9 peu de points d\xE9crivent une surface, un endroit situ\xE9 dessus peut se trouver juste \xE0 l\u2019int\xE9rieur\xA0: reposez la question avec une plus grande hauteur au-dessus du point cliqu\xE9.","Which part?":"Quelle partie\xA0?","Who sees this":"Qui voit cet endroit\xA0?","Whole scene":"Tout","Window: west, south, east, north in the coordinates of the file":"Fen\xEAtre\xA0: ouest, sud, est, nord dans les coordonn\xE9es du fichier","With open directions, up to {0} m":"Avec les directions ouvertes, jusqu\u2019\xE0 {0} m","Without any shade":"Sans aucune ombre","Write one below, such as Europe/Amsterdam or +02:00.":"Indiquez-en un ci-dessous, par exemple Europe/Amsterdam ou +02:00.",Zoom:"Zoom","about {0}":"environ {0}","all of it":"tout le fichier",azimuth:"azimut","ball file":"fichier de boules",blocked:"masqu\xE9","blocked here":"vue masqu\xE9e ici",bridge:"pont",building:"b\xE2timent","by the longitude of the place, without summer time: look whether it is right":"d\u2019apr\xE8s la longitude du lieu, sans heure d\u2019\xE9t\xE9\xA0; v\xE9rifiez qu\u2019il est correct","by the plan, of {0} points of the cloud.":"avec le projet, sur {0} points du nuage.","civil structure":"ouvrage d\u2019art","class {0}":"classe {0}","edge of a roof":"bord de toit",feet:"pieds","from {0} to {1}, of {2} points of the cloud.":"de {0} \xE0 {1}, sur {2} points du nuage.",ground:"sol","high noise":"bruit haut","high vegetation":"v\xE9g\xE9tation haute","horizon; dashed: 21 June, March, December":"horizon\xA0; en tirets\xA0: 21\xA0juin, 21\xA0mars, 21\xA0d\xE9cembre","in shadow":"\xE0 l\u2019ombre","in shadow at both times":"\xE0 l\u2019ombre aux deux moments","in shadow before and after":"\xE0 l\u2019ombre avant et apr\xE8s","inside an obstacle":"dans un obstacle","inside of a building":"int\xE9rieur d\u2019un b\xE2timent","is the solar energy received by {0} m\xB2 of panels from sun and sky, not electricity: panels turn a part of it into that. It is for a sky without clouds, an upper bound. With a file of weather, the command below gives less.":"c\u2019est l\u2019\xE9nergie solaire que {0}\xA0m\xB2 de panneaux re\xE7oivent du soleil et du ciel, et non de l\u2019\xE9lectricit\xE9\xA0: les panneaux n\u2019en convertissent qu\u2019une partie. La valeur suppose un ciel sans nuages\xA0: c\u2019est un maximum. Avec un fichier m\xE9t\xE9o, la commande ci-dessous donne moins.","known to {0} cm (standard deviation)":"connue \xE0 {0} cm pr\xE8s (\xE9cart type)",lit:"au soleil","lit at both times":"au soleil aux deux moments","lit before and after":"au soleil avant et apr\xE8s","lit only after":"au soleil seulement apr\xE8s","lit only at the first time":"au soleil au premier moment seulement","lit only at the second time":"au soleil au second moment seulement","lit only before":"au soleil seulement avant","lit with a probability of {0} %":"au soleil avec une probabilit\xE9 de {0}\xA0%","lit, unproven":"au soleil, non prouv\xE9","low noise":"bruit bas","low vegetation":"v\xE9g\xE9tation basse","m high":"m de haut","medium vegetation":"v\xE9g\xE9tation moyenne",metres:"m\xE8tres","metres, unless the file says otherwise":"m\xE8tres, sauf indication contraire du fichier",millimetres:"millim\xE8tres","never classified":"jamais class\xE9","no answer":"pas de r\xE9ponse",none:"aucun","not visible before and after":"visible ni avant ni apr\xE8s","nothing leaves this computer":"rien ne quitte cet ordinateur","of ground, by eyes 1.7 m above it.":"de sol, par des yeux situ\xE9s \xE0 1,7\xA0m au-dessus.","of the points of the cloud, {0}.":"parmi les points du nuage, le {0}.","of the points of the cloud.":"parmi les points du nuage.","on average on {0}, of {1} possible hours.":"en moyenne le {0}, sur {1}\xA0h possibles.","on average on {0}, on the ground that is free before and after.":"en moyenne le {0}, sur le sol qui est libre avant et apr\xE8s.","on {0}, of {1} hours between sunrise and sunset.":"le {0}, sur {1}\xA0h entre le lever et le coucher du soleil.","or drop them here":"ou d\xE9posez-les ici","outside the cloud":"hors du nuage",parapet:"parapet",pylon:"pyl\xF4ne",rail:"voie ferr\xE9e","ridge or valley":"fa\xEEte ou noue","road surface":"chauss\xE9e",roof:"toit","scale bar":"barre d\u2019\xE9chelle",slope:"pente","step of a roof":"d\xE9crochement de toit",strong:"forte","structure on a roof":"construction sur un toit","that of the place":"celui du lieu","that of the place; a border with other clocks is near, so look whether it is right":"celui du lieu\xA0; une fronti\xE8re avec une autre heure est proche, v\xE9rifiez donc qu\u2019il est correct","this computer's":"celui de cet ordinateur","this computer's, which fits the place":"celui de cet ordinateur, qui convient au lieu","this computer's, which fits the place; a border with other clocks is near, so look whether it is right":"celui de cet ordinateur, qui convient au lieu\xA0; une fronti\xE8re avec une autre heure est proche, v\xE9rifiez donc qu\u2019il est correct","this computer's, which may fit the place":"celui de cet ordinateur, qui peut convenir au lieu",unclassified:"non class\xE9",unproven:"non prouv\xE9",up:"vers le haut",upright:"verticale",visible:"visible","visible before and after":"visible avant et apr\xE8s","visible only after":"visible seulement apr\xE8s","visible only before":"visible seulement avant",wall:"mur",water:"eau",weak:"faible",wire:"c\xE2ble","{0} % sure":"S\xFBr \xE0 {0}\xA0%","{0} corners.":"{0}\xA0coins.","{0} hours of sun":"{0}\xA0h d\u2019ensoleillement","{0} is lit":"{0} au soleil","{0} is visible":"{0} visibles","{0} kWh a year":"{0}\xA0kWh par an","{0} of {1}":"{0} sur {1}","{0} of {1} m":"{0} de {1}\xA0m","{0} of {1} points drawn":"{0} points affich\xE9s sur {1}","{0} points":"{0}\xA0points","{0} points are hidden":"{0} points sont masqu\xE9s","{0} points come into view":"{0} points deviennent visibles","{0} points gain the sun":"{0} points passent au soleil","{0} points lose the sun":"{0} points passent \xE0 l\u2019ombre","{0} scenes are kept in this browser ({1} MB): the same files open in a moment.":"{0}\xA0sc\xE8nes sont conserv\xE9es dans ce navigateur ({1}\xA0Mo)\xA0: les m\xEAmes fichiers s\u2019ouvrent en un instant.","{0} to {1}":"de {0} \xE0 {1}","{0}, shown":"{0}, affich\xE9","{0}, which scatter by {1} cm":"{0}, dispers\xE9s de {1} cm","{0}\xB0 from north":"{0}\xB0 depuis le nord"},stages:{reading:"lecture",cleaning:"nettoyage","estimating scanner positions":"estimation des positions du scanner","indexing pulses":"indexation des impulsions laser","grouping pulses":"regroupement des impulsions laser","indexing points":"indexation des points","estimating normals":"estimation des normales","orienting normals":"orientation des normales","measuring crowns":"mesure des couronnes d\u2019arbres","marking crowns":"marquage des couronnes d\u2019arbres","finding vegetation":"recherche de la v\xE9g\xE9tation","finding thin objects":"recherche des objets fins","finding thin surfaces":"recherche des surfaces minces","shrinking balls":"r\xE9duction des boules","carving balls":"rognage des boules","cutting at roof edges":"coupe aux bords des toits","cutting at data voids":"coupe aux zones sans donn\xE9es","finding thin relief":"recherche des reliefs fins","pruning balls":"suppression des boules superflues",filling:"remplissage","finding roofs and walls":"recherche des toits et des murs","capping balls":"limitation des boules","indexing balls":"indexation des boules","checking pulses":"v\xE9rification des impulsions laser","keeping scene":"conservation de la sc\xE8ne","reading kept scene":"lecture de la sc\xE8ne conserv\xE9e","closing floors below tripods":"fermeture des sols sous les tr\xE9pieds"},remarks:{"targets-near-edge":"{count} cibles sur {of} ({percent}\xA0%) sont proches du bord du nuage\xA0: des objets situ\xE9s au-del\xE0, aussi hauts que son point le plus haut, pourraient leur prendre une partie de leur soleil ou de leur ciel","light-unproven":"{count} des {of} cibles au soleil ({percent}\xA0%) le sont d\u2019apr\xE8s les points, mais aucune impulsion laser ne prouve que leur chemin vers le soleil est libre","suns-below-horizon":"{count} positions du soleil sur {of} ({percent}\xA0%) sont sous l\u2019horizon\xA0: rien n\u2019est au soleil","ground-not-believed":"{count} points de classe\xA02 sur {of} ({percent}\xA0%) se trouvent plusieurs m\xE8tres au-dessous ou au-dessus du sol alentour et ne sont pas jug\xE9s fiables","targets-inside-obstacle":"{count} cibles sur {of} ({percent}\xA0%) sont \xE0 l\u2019int\xE9rieur d\u2019un obstacle, ou leur \u0153il s\u2019y trouve\xA0: elles ne sont ni visibles ni masqu\xE9es","probability-from-the-ground":"le scanner \xE9tait pos\xE9 au sol\xA0: les probabilit\xE9s pour ce qu\u2019il n\u2019a pas vu, comme les toits et les murs tourn\xE9s de l\u2019autre c\xF4t\xE9, peuvent \xEAtre fausses d\u2019un quart","no-roofs":"aucun toit n\u2019a \xE9t\xE9 trouv\xE9\xA0: les toits se reconnaissent aux points de classe\xA06 ou, s\u2019il n\u2019y en a pas, aux retours uniques des classes 0 et\xA01 situ\xE9s au-dessus des points de classe\xA02\xA0; classez d\u2019abord les points s\u2019il y a des b\xE2timents","nothing-cleared":"il n\u2019y a rien \xE0 d\xE9gager \xE0 cet endroit","small-roof-planes":"{count} pans de toit ({area_m2}\xA0m\xB2) sont trop petits pour des panneaux et ne figurent pas dans la liste","end-inside-obstacle":"l\u2019endroit est \xE0 l\u2019int\xE9rieur d\u2019un obstacle, \xE0 {depth_m}\xA0m de profondeur\xA0: on n\u2019y voit rien et on ne le voit de nulle part\xA0; indiquez un endroit \xE0 l\u2019ext\xE9rieur","true-north-unknown":"les azimuts sont compt\xE9s depuis le nord de la grille, car le nord g\xE9ographique est inconnu\xA0: la sc\xE8ne n\u2019a pas de syst\xE8me de r\xE9f\xE9rence utilisable (code EPSG ou WKT)","y-looks-up":"dans ce nuage, y semble dirig\xE9 vers le haut, et non z : ses surfaces planes sont orient\xE9es selon y","unit-of-room":"ce nuage ressemble \xE0 une pi\xE8ce en millim\xE8tres ou en centim\xE8tres, et a \xE9t\xE9 lu en m\xE8tres : choisissez l\u2019unit\xE9"},refusals:{"This place is outside the cloud, where nothing is known.":"Cet endroit est hors du nuage de points, o\xF9 rien n\u2019est connu.","A and B are the same place: click two different ones.":"A et B sont au m\xEAme endroit\xA0: cliquez sur deux endroits diff\xE9rents.","An area needs at least three corners.":"Une zone a besoin d\u2019au moins trois sommets.","A building or an area needs at least three corners.":"Un b\xE2timent ou une zone a besoin d\u2019au moins trois sommets.","A building needs a height above 0 m.":"Un b\xE2timent doit avoir une hauteur de plus de 0\xA0m.","There is no sun at this time.":"Il n\u2019y a pas de soleil \xE0 cette heure.","Nobody can look from this place.":"Personne ne peut regarder depuis cet endroit.","The plan is not kept any more: change it, or load the page again.":"Le projet n\u2019est plus en m\xE9moire\xA0: modifiez-le ou rechargez la page.","The mesh is not kept any more: load it again.":"Le mod\xE8le 3D n\u2019est plus en m\xE9moire\xA0: chargez-le \xE0 nouveau.","There is no plane of a roof here: click a roof of at least 4 m\xB2.":"Il n\u2019y a pas de pan de toit ici\xA0: cliquez sur un toit d\u2019au moins 4\xA0m\xB2.","Meshes, rasters and shapes are shown with a cloud: choose one too.":"Les mod\xE8les, rasters et formes s\u2019affichent avec un nuage de points\xA0: choisissez-en un aussi."}};var $h={texts:{"1 corner.":"1 hoekpunt.","1 scene is kept in this browser ({0} MB): the same files open in a moment.":"In deze browser is 1 sc\xE8ne bewaard ({0} MB): dezelfde bestanden gaan in een ogenblik open.","1 under a free sky, 0 without any sky.":"1 onder de vrije hemel, 0 als er geen hemel te zien is.","A file on the web, a reference system, a part of a file":"Een bestand op internet, een co\xF6rdinatenstelsel, een deel van een bestand","A first answer from a sample of them; the exact one follows \u2026":"Een eerste antwoord op basis van een steekproef daaruit; het exacte antwoord volgt \u2026","A first answer from a sample of {0} points; the exact one follows \u2026":"Een eerste antwoord op basis van een steekproef van {0} punten; het exacte antwoord volgt \u2026","A to B":"A naar B",About:"Ongeveer","Address of a file on the web, or of a catalogue of tiles (.vpc, STAC); of COPC, only the part that is opened is transferred":"Adres van een bestand op internet, of van een catalogus van tegels (.vpc, STAC); van COPC wordt alleen het deel opgehaald dat wordt geopend",After:"Na","Ahead (W)":"Vooruit (W)",Answer:"Antwoord","Answered in {0} ms.":"Beantwoord in {0} ms.","Answers before or after the plan, or the change":"Antwoorden v\xF3\xF3r of na het plan, of het verschil","Area in its plane":"Oppervlakte in het eigen vlak","Area of the plane":"Oppervlakte van het dakvlak","Area on the map":"Oppervlakte op de kaart","As measured":"Zoals gemeten",Ask:"Vraag stellen","Ask about this place":"Stel een vraag over deze plek","Ask at the centre of the view":"Vraag stellen in het midden van het beeld","Asking \u2026":"De vraag wordt beantwoord \u2026","At least three corners are needed.":"Er zijn minstens drie hoekpunten nodig.","At the time below":"Op het tijdstip hieronder","Axis that is up":"As die omhoog wijst","Azimuth of the sun":"Azimut van de zon","B is blocked":"B is geblokkeerd","B is unproven":"B is onbewezen","B is visible from A":"B is zichtbaar vanuit A","Back (S)":"Achteruit (S)",Balls:"Bollen",Before:"V\xF3\xF3r","Before, after, change of a plan":"V\xF3\xF3r of na een plan, of het verschil","Between the two times":"Tussen de twee tijdstippen","Blocked after":"Geblokkeerd na","Blocked at":"Geblokkeerd bij","Building {0}":"Gebouw {0}",Cancel:"Annuleren",Cells:"Cellen",Change:"Verschil","Change of the hours of sun":"Verschil in zonuren","Changing the scene \u2026":"De sc\xE8ne wordt aangepast \u2026","Choose a day below.":"Kies hieronder een dag.","Choose a question":"Een vraag kiezen","Choose a question on the left, then click a place. Every answer is computed by the program on this computer, and shows the command that gives the same.":"Kies links een vraag en klik dan op een plek. Elk antwoord wordt door het programma op deze computer berekend en toont de opdracht die hetzelfde oplevert.","Choose a question on the left. This file holds the answers that were computed when it was made, each with the command that gives the same.":"Kies links een vraag. Dit bestand bevat de antwoorden die zijn berekend toen het werd gemaakt, elk met de opdracht die hetzelfde oplevert.","Choose a viewpoint: its view is in this file.":"Kies een standpunt: wat vandaar te zien is, staat in dit bestand.","Choose another date or time below.":"Kies hieronder een andere datum of tijd.","Choose files":"Kies bestanden","Choose the files again: they are read as chosen below.":"Kies de bestanden opnieuw: ze worden gelezen zoals hieronder gekozen.",Class:"Klasse","Clear an area":"Gebied leegmaken","Cleared area {0}":"Leeggemaakt gebied {0}","Click A, where the eye is, then B.":"Klik op A, waar het oog zich bevindt, en dan op B.","Click a place to measure its sky view and the space that is visible from it.":"Klik op een plek om te meten hoeveel hemel en hoeveel ruimte vandaar te zien is.","Click a place to see when the sun reaches it.":"Klik op een plek om te zien wanneer de zon er komt.","Click a roof to see what sun and sky send to its plane in a year of clear sky.":"Klik op een dak om te zien hoeveel energie het dakvlak van zon en hemel krijgt in een jaar met onbewolkte hemel.","Click a target to see from where people can see it.":"Klik op een doel om te zien vanwaar mensen het kunnen zien.","Click anywhere to ask":"Klik ergens om te vragen","Click around what shall go, such as a tree or a house.":"Klik rondom wat weg moet, zoals een boom of een huis.","Click more places for a longer line or an area.":"Klik op meer plekken voor een langere lijn of een oppervlakte.","Click more, or go on with these.":"Klik er meer aan, of ga hiermee verder.","Click more.":"Klik er meer aan.","Click places to measure between them.":"Klik op plekken om daartussen te meten.","Click the corners of the area.":"Klik op de hoekpunten van het gebied.","Click the corners of the building.":"Klik op de hoekpunten van het gebouw.","Click the opposite corner.":"Klik op het hoekpunt ertegenover.","Click two corners, or move the heights.":"Klik op twee hoekpunten, of verschuif de hoogten.","Click two places for a length, more for an area.":"Klik op twee plekken voor een lengte, op meer plekken voor een oppervlakte.","Click where somebody stands: ground, balcony or roof.":"Klik op de plek waar iemand staat: grond, balkon of dak.",Close:"Sluiten","Close the answer":"Het antwoord sluiten",Colour:"Kleur","Colour of the points":"Kleur van de punten","Compare no longer":"Niet meer vergelijken","Compare this time with another":"Dit tijdstip met een ander vergelijken","Coordinates under the pointer":"Co\xF6rdinaten onder de aanwijzer",Copied:"Gekopieerd","Copy command":"Opdracht kopi\xEBren",Cut:"Uitsnede",Dark:"Donker",Date:"Datum","Date and time":"Datum en tijd","Read it again":"Opnieuw lezen","Read it with y up":"Lezen met y omhoog","Read it with z up":"Lezen met z omhoog","Reference system":"Co\xF6rdinatenstelsel","Share of open directions":"Aandeel open richtingen",Size:"Afmetingen","The cloud, and how it is read":"De puntenwolk en hoe die wordt gelezen","Times are those of {0}.":"De tijden zijn die van {0}.","To read it with another reference system or up axis, end the program and start it with --crs or --up.":"Voor een ander co\xF6rdinatenstelsel of een andere as omhoog: sluit het programma af en start het met --crs of --up.","Unit, where the file names none":"Eenheid, als het bestand er geen noemt","Unit, which the files do not name":"Eenheid, die de bestanden niet noemen",centimetres:"centimeter","deck, canopy or balcony":"dek, luifel of balkon","Down (Q)":"Omlaag (Q)","Drag to turn, right drag to move, wheel to zoom. Click a point for its coordinates.":"Sleep om te draaien, sleep met de rechtermuisknop om te verschuiven, draai aan het muiswiel om te zoomen. Klik op een punt voor de co\xF6rdinaten.","Draw a building":"Gebouw tekenen","Draw or load what is planned, clear what goes; then ask again.":"Teken of laad wat er gepland is en haal weg wat verdwijnt; stel daarna opnieuw een vraag.",E:"O","Earlier or later":"Vroeger of later",Edges:"Randen","Elevation of the sun":"Hoogte van de zon","Eye above A":"Ooghoogte boven A","Eye above the clicked point":"Ooghoogte boven het aangeklikte punt",Faces:"Ori\xEBntatie","Farthest view in plan":"Verste zicht in plattegrond",Finish:"Voltooien","First light":"Eerste zonlicht",Fly:"Vliegen",Forget:"Wissen","From above":"Van boven","From the clicked place":"Vanaf de aangeklikte plek","From viewpoint {0}":"Vanuit standpunt {0}","From where the place is seen":"Vanwaar de plek te zien is","From {0} cells nothing is in the way, but no pulse proves it.":"Vanuit {0} cellen staat er niets in de weg, maar geen laserpuls bewijst dat.","Gains sun":"Krijgt meer zon",Go:"Verplaatsen","Go ahead":"Vooruit gaan","Go back":"Achteruit gaan","Go down":"Omlaag gaan","Go left":"Naar links gaan","Go right":"Naar rechts gaan","Go up":"Omhoog gaan","Greatest gain":"Grootste toename","Greatest loss":"Grootste afname","Ground (brown), obstacles (grey) and the line of sight":"Grond (bruin), obstakels (grijs) en de zichtlijn","Ground in the area":"Grond in het gebied",Height:"Hoogte","Height above the clicked point":"Hoogte boven het aangeklikte punt","Height of building {0} in metres":"Hoogte van gebouw {0} in meters","Height of the building":"Hoogte van het gebouw","Height of the last above the first":"Hoogte van het laatste punt boven het eerste",Help:"Help","Hours of sun on the 21st of each month":"Zonuren op de 21e van elke maand","Hours of sun on the day":"Zonuren op deze dag","How likely it is lit":"Kans dat het in de zon ligt","How likely it is visible":"Kans dat het zichtbaar is","In nine of ten cases":"In negen van de tien gevallen",Intensity:"Intensiteit","Is B seen from A":"Is B te zien vanuit A","It is {0} there now, and the sun is down or near the horizon: this is noon, when it stands highest.":"Het is daar nu {0}, en de zon is onder of staat vlak boven de horizon: dit is midden op de dag, wanneer de zon het hoogst staat.","Its height":"Hoogte van het vlak","Its points":"Punten daarop","Keys and help (?)":"Toetsen en help (?)","LAZ, LAS, COPC, E57, PLY, PCD, PTX, text; with them models and maps: OBJ, CityJSON, GeoTIFF, GeoJSON":"LAZ, LAS, COPC, E57, PLY, PCD, PTX, tekst; daarbij modellen en kaarten: OBJ, CityJSON, GeoTIFF, GeoJSON",Language:"Taal","Last light":"Laatste zonlicht",Least:"Laagste","Left (A)":"Naar links (A)",Legend:"Legenda",Length:"Lengte","Length of the line":"Lengte van de zichtlijn","Length on the map":"Lengte op de kaart","Less sure, or unproven":"Minder zeker, of onbewezen","Let light through":"Laten licht door",Light:"Licht","Light or dark":"Licht of donker","Light or dark (L)":"Licht of donker (L)","Lit, but unproven":"In de zon, maar onbewezen","Load a mesh":"3D-model laden","Longest stretch":"Langste tijd achtereen",Look:"Kijken","Look around":"Rondkijken","Look straight down, north up (T)":"Recht naar beneden kijken, noorden boven (T)","Loses sun":"Krijgt minder zon","Lost by shade, each panel for itself":"Verlies door schaduw, elk paneel apart","Lost by shade, panels in strings":"Verlies door schaduw, panelen in serie",Map:"Kaart",Measure:"Meten","Measure lengths, heights and areas (R)":"Lengten, hoogten en oppervlakten meten (R)","Mesh file":"Bestand met 3D-model",Meshes:"3D-modellen",Most:"Hoogste",Move:"Bewegen","Move the time, or play the day.":"Verschuif de tijd, of speel de dag af.","Move; down and up":"Verplaatsen; omlaag en omhoog",N:"N","Nearest obstacle in plan":"Dichtstbijzijnde obstakel in plattegrond","Next colour":"Volgende kleur","Next way of moving":"Volgende manier van bewegen","No answer":"Geen antwoord","No answer: A or B is inside an obstacle":"Geen antwoord: A of B ligt binnen een obstakel","No answer: outside the cloud":"Geen antwoord: buiten de puntenwolk","No ground is known that sees it":"Geen plek op de grond bekend vanwaar dit te zien is","No scan at hand?":"Geen scan bij de hand?","No tile of the catalogue lies there.":"Daar ligt geen tegel van de catalogus.","Not above":"Niet hoger dan","Not below":"Niet lager dan","Nothing blocks what is unproven, but part of the line runs through space that no laser pulse has seen.":"Wat onbewezen is, wordt door niets geblokkeerd, maar een deel van de zichtlijn loopt door ruimte waar geen laserpuls is geweest.","Nothing stands in the line.":"Er staat niets in de zichtlijn.","Now click B.":"Klik nu op B.","One finger turns, two fingers move and zoom. Tap a point for its coordinates.":"Met \xE9\xE9n vinger draait u, met twee vingers verschuift en zoomt u. Tik op een punt voor de co\xF6rdinaten.",Open:"Openen","Open a laser scan of a place, and click to ask. Trees, balconies and bridges count, and what the scan cannot tell is said. Everything is computed in this browser, also without a network:":"Open een laserscan van een plek en klik om een vraag te stellen. Bomen, balkons en bruggen tellen mee, en er wordt bij gezegd wat de scan niet kan uitwijzen. Alles wordt in deze browser berekend, ook zonder netwerk:","Open a point cloud":"Een puntenwolk openen","Open a simulated town":"Een gesimuleerde stad openen","Open another file":"Een ander bestand openen","Open this part":"Dit deel openen",Orbit:"Draaien","Orbit: drag to turn, right drag to move, wheel to zoom.":"Draaien: sleep om te draaien, sleep met de rechtermuisknop om te verschuiven, draai aan het muiswiel om te zoomen.","Orbit: one finger turns, two fingers move and zoom.":"Draaien: met \xE9\xE9n vinger draait u, met twee vingers verschuift en zoomt u.","Own colours":"Eigen kleuren","Panorama from north to north: sky blue, near dark, far light":"Panorama van noord tot noord: hemel blauw, dichtbij donker, ver weg licht","Panorama of distances around the place, north at both ends":"Panorama van de afstanden rondom de plek, met het noorden aan beide uiteinden",Pause:"Pauze",Picture:"Afbeelding",Place:"Plek",Plain:"E\xE9n kleur",Plan:"Plan","Plan buildings":"Gebouwen plannen","Plan of the visible space at the height of the eye":"Plattegrond van de zichtbare ruimte op ooghoogte","Plan of the visible space, {0} square metres":"Plattegrond van de zichtbare ruimte, {0} vierkante meter",Plane:"Dakvlak","Plane of the roof":"Dakvlak",Play:"Afspelen","Play the day":"De dag afspelen","Play the day (Space)":"De dag afspelen (spatiebalk)","Point cloud. Arrow keys turn the view, plus and minus zoom, Enter asks the selected question at the centre. Press ? for all keys.":"Puntenwolk. Met de pijltoetsen draait u het beeld, met plus en min zoomt u, met Enter stelt u de gekozen vraag in het midden van het beeld. Druk op ? voor alle toetsen.",Points:"Punten",Preparing:"Voorbereiden","Preparing: {0}":"Voorbereiden: {0}","Probability that B is visible":"Kans dat B zichtbaar is","Profile of the line of sight":"Profiel van de zichtlijn",Questions:"Vragen","Questions are now answered with the plan. Before, after and change are at the top (V).":"Vragen worden nu met het plan beantwoord. V\xF3\xF3r, na en verschil staan bovenaan (V).","Received by a square metre":"Ontvangen per vierkante meter","Reference system, where the file names none":"Co\xF6rdinatenstelsel, als het bestand er geen noemt",Remove:"Verwijderen","Remove {0}":"{0} verwijderen","Right (D)":"Naar rechts (D)",Roof:"Dak",S:"Z","Save a picture":"Een afbeelding opslaan","Save a picture (P)":"Een afbeelding opslaan (P)","Save {0}":"{0} opslaan",Seen:"Zicht","Seen from":"Gezien door","Seen from {0} m\xB2":"Te zien vanaf {0} m\xB2",Shadow:"Schaduw","Shadow at a time":"Schaduw op een tijdstip","Share of possible sun":"Aandeel van de mogelijke zon","Show a part":"Een deel tonen","Show a part of the points (X)":"Een deel van de punten tonen (X)","Show all":"Alles tonen","Show all of it (H)":"Alles in beeld brengen (H)","Show edges of roofs, ridges and walls as they were found (O)":"De dakranden, nokken en muren tonen zoals ze zijn gevonden (O)","Show how sure each answer is":"Tonen hoe zeker elk antwoord is","Show the balls that block lines of sight (B)":"De bollen tonen die zichtlijnen blokkeren (B)","Show the meshes beside the cloud":"De 3D-modellen bij de puntenwolk tonen","Shows a part of the points alone: between two heights, and, after two clicks, between these corners on the map. Answers still count all of them.":"Toont alleen een deel van de punten: tussen twee hoogten en, na twee klikken, tussen deze hoekpunten op de kaart. In de antwoorden tellen nog steeds alle punten mee.",Sky:"Hemel","Sky and space here":"Hemel en ruimte op deze plek","Sky openness":"Openheid van de hemel","Sky view factor {0}":"Hemelzichtfactor {0}",Slope:"Helling","Solar energy of a roof":"Zonne-energie op een dak","Solar energy received in each month":"Ontvangen zonne-energie per maand","Solar energy received in each month, kWh/m\xB2":"Ontvangen zonne-energie per maand, kWh/m\xB2",Solid:"Dicht",Space:"Spatiebalk","Start again":"Opnieuw beginnen","Stored in this file.":"Opgeslagen in dit bestand.",Sun:"Zon","Sun here":"Zon op deze plek","Sun hours":"Zonuren","Sun hours of an area":"Zonuren van een gebied",Table:"Tabel","Tap anywhere to ask":"Tik ergens om te vragen","The answer comes as soon as the scene is ready.":"Het antwoord komt zodra de sc\xE8ne klaar is.","The catalogue has {0} tiles. Choose the part to open: {1} by {2}, in the unit of the files.":"De catalogus heeft {0} tegels. Kies het deel dat geopend moet worden: {1} bij {2}, in de eenheid van de bestanden.","The connection to Belvedere is lost. Is the program still running?":"De verbinding met Belvedere is verbroken. Draait het programma nog?","The date is missing":"De datum ontbreekt","The files from above, and the part to open. Arrow keys move it.":"De bestanden van boven gezien, en het deel dat geopend wordt. Met de pijltoetsen verschuift u dat deel.","The files have {0} million points, and this browser has room for {1} million. Choose the part to open: {2} by {3}, in the unit of the file.":"De bestanden bevatten {0} miljoen punten, en deze browser heeft ruimte voor {1} miljoen. Kies het deel dat geopend moet worden: {2} bij {3}, in de eenheid van het bestand.","The line meets a surface of the survey ({0}) {1} from A.":"De zichtlijn raakt op {1} van A een opgemeten oppervlak ({0}).","The line meets an obstacle {0} from A.":"De zichtlijn raakt op {0} van A een obstakel.","The location is unknown":"De ligging is onbekend","The same on the command line":"Hetzelfde op de opdrachtregel","The scene is lost: this tab has run out of memory, or Belvedere failed. Open the file again, or a smaller part of it.":"De sc\xE8ne is verloren gegaan: dit tabblad heeft geen geheugen meer, of er ging iets mis in Belvedere. Open het bestand opnieuw, of een kleiner deel ervan.","The scene on the command line":"De sc\xE8ne op de opdrachtregel","The server answers with {0}.":"De server antwoordt met {0}.","The sun is below the horizon":"De zon staat onder de horizon","The sun needs to know where on earth the cloud lies, but its file names no reference system. Open it again with the reference system of the cloud.":"Voor de zon moet bekend zijn waar op aarde de puntenwolk ligt, maar het bestand noemt geen co\xF6rdinatenstelsel. Open het opnieuw met het co\xF6rdinatenstelsel van de puntenwolk.","The sun on {0} over the horizon of the place":"De zon op {0} boven de horizon van de plek","The time zone is missing":"De tijdzone ontbreekt","The window needs four numbers: west, south, east, north.":"Voor de uitsnede zijn vier getallen nodig: west, zuid, oost, noord.","There is no point of the cloud at this place. Click on a point.":"Op deze plek ligt geen punt van de puntenwolk. Klik op een punt.","This browser has no WebGL 2, which the page needs. Try another browser, or switch on hardware acceleration.":"Deze browser heeft geen WebGL 2, en dat heeft de pagina nodig. Probeer een andere browser, of schakel hardwareversnelling in.","This help":"Deze help","This is now, by the clocks of the place.":"Dit is nu, volgens de klok ter plaatse.","This question is about all points. It needs no click.":"Deze vraag gaat over alle punten. Klikken is niet nodig.",Tilt:"Hellingshoek",Time:"Tijd","Time zone":"Tijdzone","Times are those of {0}: {1}.":"De tijden zijn die van {0}: {1}.",Trees:"Bomen","Try again":"Opnieuw proberen",Turn:"Draaien","Unproven length":"Onbewezen lengte","Up (E)":"Omhoog (E)",View:"Beeld",Viewpoint:"Standpunt","Viewpoint {0}":"Standpunt {0}","Visible area in plan":"Zichtbare oppervlakte in plattegrond","Visible volume up to obstacles":"Zichtbaar volume tot aan obstakels",W:"W",Walk:"Lopen","Walk: eyes 1.7 m above the ground. Fly: you go where you look. The arrows at the right go ahead, aside and back; drag to look around.":"Lopen: ogen 1,7 m boven de grond. Vliegen: u gaat waarheen u kijkt. Met de pijlen rechts gaat u vooruit, opzij en achteruit; sleep om rond te kijken.","Way of moving":"Manier van bewegen","What is seen from here":"Wat van hieruit te zien is","What is visible from here?":"Wat is van hieruit te zien?","What lies in shadow?":"Wat ligt in de schaduw?","What the plan changes":"Wat het plan verandert","Where few points tell of a surface, a place on it may lie just inside it: ask again from higher above the clicked point.":"Waar een oppervlak maar weinig punten heeft, kan een plek erop er net binnenin liggen: stel de vraag opnieuw met een grotere hoogte boven het aangeklikte punt.","Which part?":"Welk deel?","Who sees this":"Wie ziet dit","Whole scene":"Alles","Window: west, south, east, north in the coordinates of the file":"Uitsnede: west, zuid, oost, noord in de co\xF6rdinaten van het bestand","With open directions, up to {0} m":"Met open richtingen, tot {0} m","Without any shade":"Zonder enige schaduw","Write one below, such as Europe/Amsterdam or +02:00.":"Vul er hieronder een in, zoals Europe/Amsterdam of +02:00.",Zoom:"Zoomen","about {0}":"ongeveer {0}","all of it":"alles",azimuth:"azimut","ball file":"bollenbestand",blocked:"geblokkeerd","blocked here":"hier geblokkeerd",bridge:"brug",building:"gebouw","by the longitude of the place, without summer time: look whether it is right":"volgens de lengtegraad van de plek, zonder zomertijd: controleer of dit klopt","by the plan, of {0} points of the cloud.":"door het plan, van de {0} punten van de puntenwolk.","civil structure":"civiel kunstwerk","class {0}":"klasse {0}","edge of a roof":"dakrand",feet:"voet","from {0} to {1}, of {2} points of the cloud.":"van {0} tot {1}, van de {2} punten van de puntenwolk.",ground:"maaiveld","high noise":"hoge ruis","high vegetation":"hoge vegetatie","horizon; dashed: 21 June, March, December":"horizon; gestreept: 21 juni, maart, december","in shadow":"in de schaduw","in shadow at both times":"op beide tijdstippen in de schaduw","in shadow before and after":"v\xF3\xF3r en na het plan in de schaduw","inside an obstacle":"binnen een obstakel","inside of a building":"binnenkant van een gebouw","is the solar energy received by {0} m\xB2 of panels from sun and sky, not electricity: panels turn a part of it into that. It is for a sky without clouds, an upper bound. With a file of weather, the command below gives less.":"is de zonne-energie die {0} m\xB2 aan panelen van zon en hemel ontvangt, geen elektriciteit: panelen zetten daarvan een deel in elektriciteit om. Het geldt voor een hemel zonder wolken en is dus een bovengrens. Met een bestand met weergegevens geeft de opdracht hieronder minder.","known to {0} cm (standard deviation)":"bekend tot op {0} cm (standaardafwijking)",lit:"in de zon","lit at both times":"op beide tijdstippen in de zon","lit before and after":"v\xF3\xF3r en na het plan in de zon","lit only after":"alleen na het plan in de zon","lit only at the first time":"alleen op het eerste tijdstip in de zon","lit only at the second time":"alleen op het tweede tijdstip in de zon","lit only before":"alleen v\xF3\xF3r het plan in de zon","lit with a probability of {0} %":"met een kans van {0} % in de zon","lit, unproven":"in de zon, onbewezen","low noise":"lage ruis","low vegetation":"lage vegetatie","m high":"m hoog","medium vegetation":"middelhoge vegetatie",metres:"meter","metres, unless the file says otherwise":"meter, tenzij het bestand iets anders zegt",millimetres:"millimeter","never classified":"nooit geclassificeerd","no answer":"geen antwoord",none:"geen","not visible before and after":"v\xF3\xF3r en na het plan niet zichtbaar","nothing leaves this computer":"niets verlaat deze computer","of ground, by eyes 1.7 m above it.":"grond, met de ogen 1,7 m daarboven.","of the points of the cloud, {0}.":"van de punten van de puntenwolk, {0}.","of the points of the cloud.":"van de punten van de puntenwolk.","on average on {0}, of {1} possible hours.":"gemiddeld op {0}, van de {1} mogelijke uren.","on average on {0}, on the ground that is free before and after.":"gemiddeld op {0}, op de grond die v\xF3\xF3r en na het plan vrij is.","on {0}, of {1} hours between sunrise and sunset.":"op {0}, van de {1} uur tussen zonsopkomst en zonsondergang.","or drop them here":"of sleep ze hierheen","outside the cloud":"buiten de puntenwolk",parapet:"borstwering",pylon:"mast",rail:"spoor","ridge or valley":"nok of kilgoot","road surface":"wegdek",roof:"dak","scale bar":"schaalbalk",slope:"helling","step of a roof":"hoogtesprong in een dak",strong:"sterk","structure on a roof":"opbouw op een dak","that of the place":"de tijdzone van de plek","that of the place; a border with other clocks is near, so look whether it is right":"de tijdzone van de plek; er is een grens met een andere tijd in de buurt, dus controleer of dit klopt","this computer's":"de tijdzone van deze computer","this computer's, which fits the place":"de tijdzone van deze computer, die bij de plek past","this computer's, which fits the place; a border with other clocks is near, so look whether it is right":"de tijdzone van deze computer, die bij de plek past; er is een grens met een andere tijd in de buurt, dus controleer of dit klopt","this computer's, which may fit the place":"de tijdzone van deze computer, die misschien bij de plek past",unclassified:"niet geclassificeerd",unproven:"onbewezen",up:"naar boven",upright:"verticaal",visible:"zichtbaar","visible before and after":"v\xF3\xF3r en na het plan zichtbaar","visible only after":"alleen na het plan zichtbaar","visible only before":"alleen v\xF3\xF3r het plan zichtbaar",wall:"muur",water:"water",weak:"zwak",wire:"kabel","{0} % sure":"{0} % zeker","{0} corners.":"{0} hoekpunten.","{0} hours of sun":"{0} uur zon","{0} is lit":"{0} ligt in de zon","{0} is visible":"{0} is zichtbaar","{0} kWh a year":"{0} kWh per jaar","{0} of {1}":"{0} van {1}","{0} of {1} m":"{0} van {1} m","{0} of {1} points drawn":"{0} van {1} punten getekend","{0} points":"{0} punten","{0} points are hidden":"{0} punten raken uit het zicht","{0} points come into view":"{0} punten komen in het zicht","{0} points gain the sun":"{0} punten komen in de zon","{0} points lose the sun":"{0} punten komen in de schaduw","{0} scenes are kept in this browser ({1} MB): the same files open in a moment.":"In deze browser zijn {0} sc\xE8nes bewaard ({1} MB): dezelfde bestanden gaan in een ogenblik open.","{0} to {1}":"{0} tot {1}","{0}, shown":"{0}, getoond","{0}, which scatter by {1} cm":"{0}, met een spreiding van {1} cm","{0}\xB0 from north":"{0}\xB0 vanaf het noorden"},stages:{reading:"inlezen",cleaning:"opschonen","estimating scanner positions":"scannerposities schatten","indexing pulses":"laserpulsen indexeren","grouping pulses":"laserpulsen groeperen","indexing points":"punten indexeren","estimating normals":"normalen schatten","orienting normals":"normalen richten","measuring crowns":"boomkronen meten","marking crowns":"boomkronen markeren","finding vegetation":"vegetatie zoeken","finding thin objects":"dunne objecten zoeken","finding thin surfaces":"dunne oppervlakken zoeken","shrinking balls":"bollen verkleinen","carving balls":"bollen bijsnijden","cutting at roof edges":"afsnijden bij dakranden","cutting at data voids":"afsnijden bij gaten in de gegevens","finding thin relief":"dun reli\xEBf zoeken","pruning balls":"bollen uitdunnen",filling:"opvullen","finding roofs and walls":"daken en muren zoeken","capping balls":"bollen begrenzen","indexing balls":"bollen indexeren","checking pulses":"laserpulsen controleren","keeping scene":"sc\xE8ne bewaren","reading kept scene":"bewaarde sc\xE8ne inlezen","closing floors below tripods":"vloeren onder statieven sluiten"},remarks:{"targets-near-edge":"{count} van de {of} doelen ({percent} %) liggen dicht bij de rand van de puntenwolk: objecten daarbuiten, even hoog als het hoogste punt ervan, kunnen een deel van hun zon of hemel wegnemen","light-unproven":"{count} van de {of} doelen in de zon ({percent} %) liggen in de zon voor zover de punten laten zien, maar geen laserpuls bewijst dat hun weg naar de zon vrij is","suns-below-horizon":"{count} van de {of} zonnestanden ({percent} %) liggen onder de horizon: dan ligt niets in de zon","ground-not-believed":"{count} van de {of} punten van klasse 2 ({percent} %) liggen meters onder of boven het maaiveld eromheen en worden niet vertrouwd","targets-inside-obstacle":"{count} van de {of} doelen ({percent} %) liggen binnen een obstakel, of hun oog ligt daarbinnen: ze zijn zichtbaar noch geblokkeerd","probability-from-the-ground":"de scanner stond op de grond: kansen voor wat hij niet zag, zoals daken en afgewende muren, kunnen er een kwart naast zitten","no-roofs":"er is geen dak gevonden: daken blijken uit punten van klasse 6 of, als die er niet zijn, uit enkelvoudige reflecties van klasse 0 en 1 die boven punten van klasse 2 liggen; classificeer eerst de punten als er gebouwen zijn","nothing-cleared":"er staat daar niets wat weggehaald kan worden","small-roof-planes":"{count} dakvlakken ({area_m2} m\xB2) zijn te klein voor panelen en worden niet vermeld","end-inside-obstacle":"de plek ligt binnen een obstakel, {depth_m} m diep: vandaar is niets te zien, en de plek zelf is nergens vandaan te zien; geef een plek erbuiten op","true-north-unknown":"azimuthoeken worden gerekend vanaf het kaartnoorden, omdat het ware noorden onbekend is: de sc\xE8ne heeft geen bruikbaar co\xF6rdinatenstelsel (EPSG-code of WKT)","y-looks-up":"in deze puntenwolk lijkt y omhoog te wijzen, niet z: de vlakke oppervlakken zijn naar y gericht","unit-of-room":"deze puntenwolk ziet eruit als een kamer in millimeter of centimeter, en is in meter gelezen: kies de eenheid"},refusals:{"This place is outside the cloud, where nothing is known.":"Deze plek ligt buiten de puntenwolk, waar niets bekend is.","A and B are the same place: click two different ones.":"A en B zijn dezelfde plek: klik op twee verschillende plekken.","An area needs at least three corners.":"Een gebied heeft minstens drie hoekpunten nodig.","A building or an area needs at least three corners.":"Een gebouw of gebied heeft minstens drie hoekpunten nodig.","A building needs a height above 0 m.":"Een gebouw heeft een hoogte boven 0 m nodig.","There is no sun at this time.":"Op dit tijdstip is er geen zon.","Nobody can look from this place.":"Vanaf deze plek kan niemand kijken.","The plan is not kept any more: change it, or load the page again.":"Het plan wordt niet meer bewaard: verander het, of laad de pagina opnieuw.","The mesh is not kept any more: load it again.":"Het 3D-model wordt niet meer bewaard: laad het opnieuw.","There is no plane of a roof here: click a roof of at least 4 m\xB2.":"Hier is geen dakvlak: klik op een dak van minstens 4 m\xB2.","Meshes, rasters and shapes are shown with a cloud: choose one too.":"3D-modellen, rasters en vormen worden bij een puntenwolk getoond: kies er ook een."}};var cm={de:Hh,fr:Wh,nl:$h},us={en:"English",nl:"Nederlands",de:"Deutsch",fr:"Fran\xE7ais"},qh="language";function hm(){try{let n=localStorage.getItem(qh);if(us[n])return n}catch{}return navigator.languages.map(n=>n.slice(0,2)).find(n=>us[n])??"en"}var Mn=hm(),no=cm[Mn];function io(n){try{localStorage.setItem(qh,n)}catch{}location.reload()}var Xh=(n,e)=>n.replace(/\{(\w+)\}/g,(t,i)=>e[i]),v=(n,...e)=>Xh(hs(n.slice(1).reduce((t,i,s)=>`${t}{${s}}${i}`,n[0])),e),hs=n=>no?.texts[n]??n,Yh=n=>no?.refusals[n]??n,Zh=n=>no?.stages[n]??n;function jh({key:n,text:e,numbers:t}){let i=no?.remarks[n];return i?Xh(i,Object.fromEntries(Object.entries(t??{}).map(([s,r])=>[s,r.toLocaleString(Mn,{maximumFractionDigits:2})]))):e}var tt=n=>n.toLocaleString(Mn),ke=(n,e)=>(n+0).toLocaleString(Mn,{minimumFractionDigits:e,maximumFractionDigits:e,useGrouping:!1}),Qt=(n,e=2)=>`${ke(n,e)} m`,um=["title","aria-label","placeholder"];function Kh(n){document.documentElement.lang=Mn;let e=document.createTreeWalker(n,NodeFilter.SHOW_TEXT);for(;e.nextNode();){let t=e.currentNode.data.trim();t&&hs(t)!==t&&(e.currentNode.data=e.currentNode.data.replace(t,hs(t)))}for(let t of um)for(let i of n.querySelectorAll(`[${t}]`))i.setAttribute(t,hs(i.getAttribute(t)))}var On=class extends Error{constructor(e){super(Yh(e))}},_n=class extends Error{};function pi(n){let e=new DataView(n).getUint32(0,!0);return{...JSON.parse(new TextDecoder().decode(new Uint8Array(n,4,e))),body:n.slice(4+e)}}var dm=v`The connection to Belvedere is lost. Is the program still running?`;async function ds(n,e){let t;try{t=await fetch(n,e)}catch(i){throw i.name==="AbortError"?i:new _n(dm)}if(!t.ok){let i=await t.json().catch(()=>({}));throw new On(i.error??v`The server answers with ${t.status}.`)}return t}var Rl=(n,e,t)=>({method:"POST",headers:{"Content-Type":n},body:e,signal:t}),Jh={state:async()=>(await ds("state")).json(),part:async n=>(await ds(n)).arrayBuffer(),result:async n=>pi(await(await ds(`results/${n}`)).arrayBuffer()),ask:async(n,e,t)=>pi(await(await ds(n,Rl("application/json",JSON.stringify(e),t))).arrayBuffer()),readAgain:async n=>{await ds("reading",Rl("application/json",JSON.stringify(n))),location.replace(location.pathname)},loadMesh:async n=>pi(await(await ds(`plan-meshes/${encodeURIComponent(n.name)}`,Rl("application/octet-stream",n))).arrayBuffer())};var Qh=document.getElementById("exported"),He=Qh?JSON.parse(Qh.textContent):null,eu=n=>Uint8Array.from(atob(n),e=>e.charCodeAt(0));function fm({time:n}){let e=Number(n.slice(-5,-3))*60+Number(n.slice(-2)),t=He.suns.reduce((s,r)=>Math.abs(r.minutes-e)<Math.abs(s.minutes-e)?r:s),i=tu(t.answers).map(s=>s===3?255:s);return{...t,points:i.length,body:i.buffer}}function tu(n){let e=eu(n);return new Uint8Array(He.state.shown.point_count).map((t,i)=>e[i>>2]>>2*(i&3)&3)}function pm({viewpoint:n}){let e=He.viewpoints[n],t=tu(e.answers);return{...e,points:t.length,body:t.buffer}}var nu={state:async()=>He.state,part:async n=>{let[e,t]=n.split("/");return eu(He[e][t]).buffer},ask:async(n,e)=>n==="ask/seen"?pm(e):fm(e)};var oo=v`The scene is lost: this tab has run out of memory, or Belvedere failed. Open the file again, or a smaller part of it.`,fs=null,er=null,iu={title:"",stage:"",total:0,done:0,failure:null,remarks:[],mesh_count:0,results:[],shown:null,scene:null},vn={...iu},Pl=null,ro=new Map,ao=[],sn=null;function su(n){if(!ro.has(n)){let e,t=new Promise(i=>{e=i});ro.set(n,{promise:t,give:e})}return ro.get(n)}function Il(){if(!sn&&(sn=ao.shift()??null,!!sn)){if(sn.signal?.aborted)return sn.reject(new DOMException("nobody waits for it","AbortError")),sn=null,Il();fs.postMessage({ask:{path:sn.path,body:sn.body}})}}function so(n,e,t){return er?Promise.reject(er):new Promise((i,s)=>{ao.push({path:n,body:e,signal:t,resolve:i,reject:s}),Il()})}function ru(n){console.error(n),er=new _n(oo),vn.scene||(vn.failure=oo);for(let e of[sn,...ao])e?.reject(er);ao.length=0,sn=null}function mm({data:n}){if(n.state&&(vn={...n.state,stage:vn.stage,total:vn.total,done:vn.done}),n.stage!==void 0&&Object.assign(vn,{stage:n.stage,total:n.total,done:0}),n.done!==void 0&&(vn.done=n.done),n.counter&&(Pl=new Uint32Array(n.counter.memory.buffer,n.counter.at,1)),n.part&&su(n.part).give(n.bytes),n.tooMany&&ou(n.tooMany),n.failure&&(vn.failure=n.failure),n.lost&&ru(n.lost),n.reply&&sn){let{resolve:e,reject:t}=sn;sn=null,n.refused?t(new On(n.refused)):e(n.reply),Il()}}var ou=null,au=null;function lo(n,e,t){fs?.terminate(),vn={...iu},er=null,ou=t,au={files:n,...e},fs=new Worker("engine-worker.js"),fs.onmessage=mm,fs.onerror=i=>ru(i.message??"the worker ended"),fs.postMessage({open:{files:n,...e}})}function lu(n){let e=new Worker("engine-worker.js");return new Promise((t,i)=>{e.onmessage=({data:s})=>{s.tiles?t(s.tiles):(s.failure||s.lost)&&i(new On(s.failure??oo))},e.onerror=()=>i(new _n(oo)),e.postMessage({catalogue:n})}).finally(()=>e.terminate())}var cu={state:async()=>({...vn,done:Pl?Pl[0]:vn.done}),part:async n=>n==="balls"||n.startsWith("meshes/")?so(n,""):su(n).promise.then(e=>(ro.delete(n),e)),result:async n=>pi(await so(`results/${n}`,"")),ask:async(n,e,t)=>pi(await so(n,JSON.stringify(e),t)),readAgain:async n=>{let{files:[{url:e}],window:t}=au,i={open:e,window:t?.join(","),...n};location.hash=new URLSearchParams(Object.entries(i).filter(([,s])=>s)),location.reload()},loadMesh:async n=>pi(await so(`plan-meshes/${n.name}`,new Uint8Array(await n.arrayBuffer())))};var Yn=document.querySelector('meta[name="engine"]')!==null,Zn=He?nu:Yn?cu:Jh,hu=()=>Zn.state(),uu=async n=>new Uint16Array(await Zn.part(`points/${n}`)),Ll=async n=>new Uint16Array(await Zn.part(`colors/${n}`)),du=async n=>new Float32Array(await Zn.part(`meshes/${n}`)),fu=async()=>new Float32Array(await Zn.part("balls")),Dl=n=>Zn.result(n),An=(n,e,t,i=null)=>Zn.ask(`${i===null?"":`plans/${i}/`}ask/${n}`,e,t),pu=n=>Zn.readAgain(n),mu=n=>Zn.loadMesh(n);var ho={0:[v`never classified`,"#a9aeb5"],1:[v`unclassified`,"#c3c8ce"],2:[v`ground`,"#dcc9a0"],3:[v`low vegetation`,"#a9d8a0"],4:[v`medium vegetation`,"#55ae7f"],5:[v`high vegetation`,"#136a52"],6:[v`building`,"#d4694a"],7:[v`low noise`,"#e04fd0"],9:[v`water`,"#2f7fd6"],10:[v`rail`,"#6f5b9e"],11:[v`road surface`,"#7d828b"],14:[v`wire`,"#f2c200"],15:[v`pylon`,"#9c6b00"],17:[v`bridge`,"#b592e0"],18:[v`high noise`,"#e04fd0"],26:[v`civil structure`,"#8a5a3c"]},uo=[[[150,0,70],v`edge of a roof`],[[250,200,0],v`ridge or valley`],[[0,70,190],v`wall`]],mi=n=>[1,3,5].map(e=>parseInt(n.slice(e,e+2),16)),gu=["#440154","#482878","#3e4a89","#31688e","#26828e","#1f9e89","#35b779","#6ece58","#b5de2b","#fde725"].map(mi),co=["#1b2a5a","#3a3f86","#6a4c93","#a4508b","#d95f69","#f28e4b","#f9bf45","#fdf3a0"].map(mi),Nl=["#202328","#f4f5f7"].map(mi);function Gi(n){return Array.from({length:256},(e,t)=>{let i=t/255*(n.length-1),s=Math.min(Math.floor(i),n.length-2);return n[s].map((r,o)=>r+(n[s+1][o]-r)*(i-s))})}var gm=n=>`rgb(${n.map(Math.round).join(",")})`,ps=n=>`linear-gradient(90deg, ${n.map(gm).join(",")})`,fo=()=>{let n=document.documentElement.dataset.theme==="dark";return{0:[v`blocked`,n?"#59616d":"#8f969f"],1:[v`visible`,"#ffb000"],2:[v`unproven`,n?"#6ea5ff":"#3f7be0"],3:[v`no answer`,"#30343a"],4:[v`outside the cloud`,"#30343a"],5:[v`inside an obstacle`,"#30343a"],255:[v`no answer`,"#30343a"]}},tr={0:[v`in shadow`,"#33406f"],1:[v`lit`,"#ffdf9c"],2:[v`lit, unproven`,"#6ea5ff"],255:[v`no answer`,"#777777"]},Hi=(n,e)=>{let t=Array.from({length:256},()=>mi(e));for(let[i,[,s]]of Object.entries(n))t[i]=mi(s);return t},_m=()=>Hi(ho,"#b4b8bd"),nr=(n,e)=>e.map(t=>({color:n[t]?.[1]??"#b4b8bd",text:n[t]?.[0]??v`class ${t}`}));function kl(n,e,t){switch(n){case"class":return{mode:0,table:_m(),legend:{title:v`Class`,keys:nr(ho,e.classes.map(([i])=>i))}};case"intensity":return{mode:1,table:Gi(Nl),legend:{title:v`Intensity`,gradient:ps(Nl),ends:[v`weak`,v`strong`]}};case"height":{let i=e.heights.map((s,r)=>`${r?"\u2265":"\u2264"} ${ke(s,1)} ${e.unit}`);return{mode:2,table:Gi(gu),legend:{title:v`Height`,gradient:ps(gu),ends:i}}}case"color":return{mode:3,table:Gi(Nl),legend:null};case"answer":return t;default:return{mode:4,table:Hi({},"#b9bfc7"),legend:null}}}var Wi=(n,e=v`From the clicked place`)=>{let t=fo(),i=[1,...n.tells_unproven?[2]:[],0];return{mode:4,table:Hi(t,"#30343a"),legend:{title:e,keys:nr(t,i)}}},yu=n=>({mode:4,table:Hi(tr,"#777777"),legend:{title:v`Sun`,keys:nr(tr,[1,...n?.tells_unproven?[2]:[],0])}}),_u=["#33406f","#8d93ad","#efece4","#f7cf74","#ffb000"].map(mi),Ol=(n,e)=>{let t=Gi(_u),i=s=>s<=200?t[Math.round(s/200*255)]:mi("#777777");return{mode:4,table:t.map((s,r)=>i(r)),legend:{title:n,gradient:ps(_u),ends:e}}},bu=(n,e)=>({mode:4,table:Gi(co),legend:{title:v`Hours of sun on the day`,gradient:ps(co),ends:[n,e].map(t=>`${ke(t,1)} h`)}}),Su=(n,[e,t,i,s])=>{let r={0:[e,"#8b929b"],1:[t,"#dde0e4"],2:[i,"#e8710a"],3:[s,"#1f5fbf"]};return{mode:4,table:Hi(r,"#30343a"),legend:{title:n,keys:nr(r,[2,3,1,0])}}},vu=["#0b3c8c","#1f5fbf","#86aee0","#dde0e4","#f5b27a","#e8710a","#9c4400"].map(mi),wu=n=>({mode:4,table:Gi(vu),legend:{title:v`Change of the hours of sun`,gradient:ps(vu),ends:[`\u2212${ke(n,1)} h`,`+${ke(n,1)} h`]}}),Mu=(n,e,t)=>{let i=e==="answer"?fo():e==="lit"?tr:Object.fromEntries(["#8f969f","#ffb000","#3f7be0","#3d8c47","#a4508b"].map((s,r)=>[r,[`${r}`,s]]));return{mode:4,table:Hi(i,"#30343a"),legend:{title:n,keys:nr(i,Array.from({length:t+1},(s,r)=>r))}}},xu=n=>Math.abs(n)>=100?n.toFixed(0):Number(n.toPrecision(3)).toString(),Au=(n,e,t)=>{let i=Gi(co);return{mode:4,table:i.map((s,r)=>i[Math.min(Math.round(r*255/253),255)]),legend:{title:n,gradient:ps(co),ends:[xu(e),xu(t)]}}},Tu=n=>({mode:4,table:Hi({},n?"#5d6570":"#b3bac3"),legend:null});var Et=356,Ie=n=>String(n).replace(/[&<>"']/g,e=>`&#${e.charCodeAt(0)};`),ms=n=>n.map(([e,t],i)=>`${i?"L":"M"}${e.toFixed(1)} ${t.toFixed(1)}`).join(""),ir=(n,e,t)=>`<svg viewBox="0 0 ${Et} ${n}" width="${Et}" height="${n}" role="img" aria-label="${Ie(e)}" xmlns="http://www.w3.org/2000/svg">${t}</svg>`,Ul=n=>{if(n==null)return v`none`;let e=Math.round((n%24+24)%24*60);return`${String(Math.floor(e/60)%24).padStart(2,"0")}:${String(e%60).padStart(2,"0")}`};function Eu(n,e){let o=Math.max(30,...n.months.flatMap(S=>S.path.map(R=>R[2])),...n.path.map(S=>S[2])),a=Math.min(90,Math.ceil(o/10)*10+5),l=n.latitude_deg<0,c=S=>26+(S+(l?180:0))%360/360*(Et-26-6),h=S=>190-Math.max(S,0)/a*182,d=n.horizon_deg.length,u=Array.from({length:d+1},(S,R)=>R).map(S=>S===d?359.99:S*360/d),f=S=>n.horizon_deg[Math.floor((S+(l?180:0))%360/360*d)%d]??0,g=u.map(S=>[26+S/360*(Et-26-6),h(f(S))]),w=S=>{let R=[[]];return S.forEach(([,T,M],E)=>{E&&Math.abs(c(T)-c(S[E-1][1]))>Et/3&&R.push([]),R.at(-1).push([c(T),h(M)])}),R.map(ms).join("")},p=`<rect x="26" y="8" width="${Et-26-6}" height="182" fill="#dcebf9"/>`;for(let S=0;S<=a;S+=15)p+=`<path d="M26 ${h(S)}H${Et-6}" stroke="#8aa" stroke-opacity=".35"/><text x="22" y="${h(S)+4}" text-anchor="end">${S}\xB0</text>`;for(let S of[6,3,12]){let R=n.months[S-1];p+=`<path d="${w(R.path)}" fill="none" stroke="#7d8794" stroke-dasharray="3 3"/>`}p+=`<path d="${ms(g)}L${Et-6} 190L26 190Z" fill="#5f6b78"/>`,n.path.forEach(([,S,R],T)=>{let M=n.lit[T]?"#f5a300":"#2f3d73";p+=`<circle cx="${c(S).toFixed(1)}" cy="${h(R).toFixed(1)}" r="3.1" fill="${M}"/>`});let m=-99;for(let[S,R,T]of n.path){let M=Math.round(S);Math.abs(S-M)>.09||M%3||M===m||(m=M,p+=`<text x="${c(R).toFixed(1)}" y="${(h(T)-8).toFixed(1)}" text-anchor="middle" style="paint-order:stroke;stroke:#fff;stroke-width:3px;fill:#1c2530">${M} h</text>`)}return[v`N`,v`E`,v`S`,v`W`].forEach((S,R)=>{p+=`<text x="${c(R*90+.01)}" y="205" text-anchor="middle">${S}</text>`}),ir(214,v`The sun on ${e} over the horizon of the place`,p)}var Cu=n=>new Date(Date.UTC(2026,n,15)).toLocaleString(Mn,{month:"narrow",timeZone:"UTC"});function Ru(n){let i=4.666666666666667,s=Et/12;return ir(116,v`Hours of sun on the 21st of each month`,n.months.map(({sun_hours:r,possible_hours:o},a)=>{let l=a*s+4;return`<rect x="${l}" y="${96-o*i}" width="${s-8}" height="${o*i}" fill="#8d97a5" opacity=".35"/><rect x="${l}" y="${96-r*i}" width="${s-8}" height="${r*i}" fill="#f5a300"/><text x="${l+s/2-4}" y="111" text-anchor="middle">${Cu(a)}</text><text x="${l+s/2-4}" y="${96-o*i-3}" text-anchor="middle" style="font-size:10px">${ke(r,1)}</text>`}).join(""))}function Pu(n){let i=76/Math.max(...n,1),s=Et/12;return ir(112,v`Solar energy received in each month`,n.map((r,o)=>{let a=o*s+4;return`<rect x="${a}" y="${94-r*i}" width="${s-8}" height="${r*i}" fill="#f5a300"/><text x="${a+s/2-4}" y="107" text-anchor="middle">${Cu(o)}</text><text x="${a+s/2-4}" y="${94-r*i-3}" text-anchor="middle" style="font-size:10px">${r.toFixed(0)}</text>`}).join(""))}function Iu({distance_m:n,ground:e,line:t,solid:i,blocked_at_m:s},r){let h=[...e,...t,...i.flat(2)].filter(M=>M!==null),d=[...t,...e].filter(M=>M!==null),u=Math.min(...d)-1.5,f=Math.min(Math.max(...h),Math.max(...d)+25)+1.5,g=n.at(-1)||1,w=M=>38+M/g*(Et-38-6),p=M=>166-(Math.max(u,Math.min(f,M))-u)/(f-u)*156,m=Math.max((Et-38-6)/n.length,.6)+.3,S=i.map((M,E)=>M.filter(([,_])=>_>u).map(([_,A])=>`<rect x="${w(n[E]).toFixed(1)}" y="${p(A).toFixed(1)}" width="${m.toFixed(2)}" height="${Math.max(p(_)-p(A),.4).toFixed(1)}" fill="#98a1ad"/>`).join("")).join(""),R=n.map((M,E)=>[M,e[E]]).filter(([,M])=>M!==null).map(([M,E])=>[w(M),p(E)]);R.length&&(S+=`<path d="${ms(R)}" fill="none" stroke="#8a6d3b" stroke-width="2"/>`);let T=(M,E)=>n.map((_,A)=>[_,t[A]]).filter(([_])=>_>=M&&_<=E).map(([_,A])=>[w(_),p(A)]);if(S+=`<path d="${ms(T(0,s??g))}" fill="none" stroke="#f5a300" stroke-width="2.4"/>`,s!==null){S+=`<path d="${ms(T(s,g))}" fill="none" stroke="#2f3d73" stroke-width="1.6" stroke-dasharray="4 3"/>`;let M=t[n.findIndex(E=>E>=s)]??t.at(-1);S+=`<circle cx="${w(s)}" cy="${p(M)}" r="4.5" fill="#d1495b" stroke="#fff"/>`}return[f-1.5,u+1.5].forEach(M=>{S+=`<text x="33" y="${p(M)+4}" text-anchor="end">${M.toFixed(0)} ${r}</text>`}),S+=`<text x="38" y="182">A</text><text x="${Et-6}" y="182" text-anchor="end">B, ${ke(g,1)} m</text>`,ir(190,v`Profile of the line of sight`,`<path d="M38 166H${Et-6}" stroke="#8aa" stroke-opacity=".5"/>${S}`)}function Lu({plan:n,isovist:e}){let i=Math.max(...n.map(([,c])=>c),1),s=104/i,r=n.map(([c,h])=>{let d=c*Math.PI/180;return[Et/2+Math.sin(d)*h*s,240/2-Math.cos(d)*h*s]}),o=10**Math.floor(Math.log10(i)),a=[1,2,5].map(c=>c*o).filter(c=>c<=i),l=`<path d="${ms(r)}Z" fill="#f5a300" fill-opacity=".35" stroke="#f5a300" stroke-width="1.5"/>`;return l+=a.map(c=>`<circle cx="${Et/2}" cy="${240/2}" r="${c*s}" fill="none" stroke="#8aa" stroke-opacity=".6" stroke-dasharray="2 3"/><text x="${Et/2+c*s*.71}" y="${240/2-c*s*.71}">${c} m</text>`).join(""),l+=`<circle cx="${Et/2}" cy="${240/2}" r="3.5" fill="#1d4e89"/><text x="${Et/2}" y="11" text-anchor="middle">${v`N`}</text>`,ir(240,v`Plan of the visible space, ${e.plan_area_m2} square metres`,l)}function Du(n,{width:e,height:t}){let i=document.createElement("canvas");Object.assign(i,{width:e,height:Math.round(t*.75)}),i.setAttribute("role","img"),i.setAttribute("aria-label",v`Panorama of distances around the place, north at both ends`);let s=i.getContext("2d"),r=s.createImageData(e,t);for(let o=0;o<n.length;o++){let a=n[o]/255,l=n[o]===0?[190,222,250]:[60+150*a,52+140*a,66+110*a];r.data.set([...l,255],4*o)}return s.putImageData(r,0,-Math.round(t*.06)),i}var Un=n=>`<svg viewBox="0 0 24 24" aria-hidden="true">${n}</svg>`,xm='<path d="M2 12s4-7 10-7 10 7 10 7-4 7-10 7S2 12 2 12z"/><circle cx="12" cy="12" r="3"/>',ym='<circle cx="12" cy="12" r="4"/><path d="M12 2v3M12 19v3M2 12h3M19 12h3M5 5l2 2M17 17l2 2M19 5l-2 2M7 17l-2 2"/>',gi=(n,e)=>`${ke(100*n/Math.max(e,1),1)} %`,Nu=(n,e,t)=>n?[[v`In nine of ten cases`,`${v`${e(n[0])} to ${e(n[1])}`} ${t}`]]:[],ku=(n,e)=>n===null?Ul(n):`${Ul(n)} (${e.ahead()})`,_i=n=>`<dl>${n.map(([e,t])=>`<dt>${Ie(e)}</dt><dd>${Ie(t)}</dd>`).join("")}</dl>`,Ou=n=>n.isFirst?`${v`About`} `:"",Uu=n=>v`A first answer from a sample of ${tt(n.points)} points; the exact one follows …`,bm=n=>{let e=10**Math.max(Math.floor(Math.log10(n))-1,0);return v`about ${tt(Math.round(n/e)*e)}`};function Fu(n,e,t){let i=fo(),s=[[1,n.visible],...n.tells_unproven!==!1?[[2,n.unproven]]:[],[0,n.blocked]],r=s.reduce((o,[,a])=>o+a,0);return`<div class="shares">${s.map(([o,a])=>`<span style="flex:${a} 0 0;background:${i[o][1]}"></span>`).join("")}</div><div class="key">${s.map(([o,a])=>`<span><i class="swatch" style="background:${i[o][1]}"></i>${i[o][0]} ${gi(a,r)}</span>`).join("")}</div>`+_i(s.map(([o,a])=>[`${e}: ${i[o][0]}`,n.isFirst&&a?bm(a*t.scene.point_count/n.points):tt(a)]))}var Fl=n=>`${ke(n,1)} %`,zu=({certainty:n},[e,t])=>{if(!n)return"";let i=v`${Math.round(100*n.certain_from)} % sure`;return _i([[`${i}: ${e}`,Fl(n.certainly_visible_percent)],[`${i}: ${t}`,Fl(n.certainly_blocked_percent)],[v`Less sure, or unproven`,Fl(n.uncertain_percent)]])},Bu=({certainty:n})=>n?Object.entries(n):[],Vu=v`Nothing blocks what is unproven, but part of the line runs through space that no laser pulse has seen.`,Gu=n=>v`by the plan, of ${n} points of the cloud.`,Sm={roof:v`roof`,wall:v`wall`,parapet:v`parapet`,step:v`step of a roof`,box:v`structure on a roof`,inside:v`inside of a building`,slab:v`deck, canopy or balcony`},sr=matchMedia("(pointer: coarse)").matches,zl=[{name:"look",short:v`Look`,title:v`Look around`,icon:Un('<path d="M12 3v18M3 12h18M12 3l-2.500 2.500M12 3l2.500 2.500M12 21l-2.500-2.500M12 21l2.500-2.500M3 12l2.500-2.500M3 12l2.500 2.500M21 12l-2.500-2.500M21 12l-2.500 2.500"/>'),hint:sr?v`One finger turns, two fingers move and zoom. Tap a point for its coordinates.`:v`Drag to turn, right drag to move, wheel to zoom. Click a point for its coordinates.`,places:1},{name:"seen",short:v`Seen`,title:v`What is seen from here`,icon:Un(xm),height:[v`Eye above the clicked point`,1.7],places:1,hint:v`Click where somebody stands: ground, balcony or roof.`,samples:!0,ask:([n])=>["seen",{place:n}],change:{title:v`What the plan changes`,names:[v`not visible before and after`,v`visible before and after`,v`visible only after`,v`visible only before`],gain:n=>v`${n} points come into view`,loss:n=>v`${n} points are hidden`,of:Gu},show(n,e){e.answer=n.certainty?Ol(v`How likely it is visible`,["0 %","100 %"]):Wi(n,n.viewpoint),e.values(new Uint8Array(n.probabilities??n.body));let t=n.visible+n.blocked+n.unproven;return`<p class="verdict">${Ou(n)}${v`${gi(n.visible,t)} is visible`}</p><p class="note">${v`of the points of the cloud.`} ${n.isFirst?Uu(n):n.tells_unproven?Vu:""}</p>${Fu(n,v`Points`,e)}${zu(n,[v`visible`,v`blocked`])}`},rows:n=>[["answer","points"],["visible",n.visible],["unproven",n.unproven],["blocked",n.blocked],...Bu(n)],properties:({visible:n,unproven:e,blocked:t})=>({visible:n,unproven:e,blocked:t})},{name:"line",short:v`A to B`,title:v`Is B seen from A`,icon:Un('<circle cx="5" cy="18" r="2.500"/><circle cx="19" cy="6" r="2.500"/><path d="M7 16 17 8"/>'),height:[v`Eye above A`,1.7],places:2,hint:v`Click A, where the eye is, then B.`,ask:([n,e])=>["line",{observer:n,target:e}],show(n,e){let t=n.first_block;e.line(n);let i={visible:v`B is visible from A`,blocked:v`B is blocked`,unproven:v`B is unproven`,"outside the cloud":v`No answer: outside the cloud`,"inside an obstacle":v`No answer: A or B is inside an obstacle`}[n.answer],s=t&&Qt(t.range_m,1),r=t?.surface?v`The line meets a surface of the survey (${Sm[t.surface]}) ${s} from A.`:v`The line meets an obstacle ${s} from A.`,o=t?r:n.answer==="unproven"?Vu:v`Nothing stands in the line.`;return`<p class="verdict">${i}</p><p class="note">${o}</p>`+(n.profile?`<figure>${Iu(n.profile,e.scene.unit)}<figcaption>${v`Ground (brown), obstacles (grey) and the line of sight`}</figcaption></figure>`:"")+_i([[v`Length of the line`,Qt(n.length_m)],...t?[[v`Blocked after`,Qt(t.range_m)],[v`Blocked at`,t.place.map(a=>a.toFixed(2)).join(", ")]]:[],...n.unproven_m!==null&&!t?[[v`Unproven length`,Qt(n.unproven_m)]]:[],...n.probability!=null?[[v`Probability that B is visible`,`${ke(100*n.probability,0)} %`]]:[]])},rows:({profile:n})=>n?[["distance_m","ground","line","solid"],...n.distance_m.map((e,t)=>[e,n.ground[t],n.line[t],n.solid[t].map(i=>i.join("..")).join(" ")])]:null,properties:n=>({answer:n.answer,length_m:n.length_m,first_block_range_m:n.first_block?.range_m??null,probability:n.probability}),geometry:n=>["LineString",n]},{name:"sun",short:v`Sun`,title:v`Sun here`,icon:Un(ym),height:[v`Height above the clicked point`,.1],places:1,time:"date",hint:v`Click a place to see when the sun reaches it.`,ask:([n],{date:e,zone:t,trees:i})=>["sun",{place:n,date:e,zone:t,trees:i}],show:(n,e)=>`<p class="verdict">${v`${ke(n.sun_hours,1)} hours of sun`}</p><p class="note">${v`on ${Ie(e.time.date)}, of ${ke(n.possible_hours,1)} hours between sunrise and sunset.`}</p><figure>${Eu(n,e.time.date)}<figcaption><i class="swatch" style="background:#f5a300"></i>${v`lit`} <i class="swatch" style="background:#2f3d73;margin-left:10px"></i>${v`in shadow`} <i class="swatch" style="background:#5f6b78;margin-left:10px"></i>${v`horizon; dashed: 21 June, March, December`}</figcaption></figure>`+_i([...Nu(n.interval_hours,t=>ke(t,1),"h"),[v`First light`,ku(n.first_light,e)],[v`Last light`,ku(n.last_light,e)],[v`Longest stretch`,`${ke(n.longest,1)} h`],[v`Share of possible sun`,gi(n.sun_share??0,1)]])+`<h3>${v`Hours of sun on the 21st of each month`}</h3><figure>${Ru(n)}</figure>`,rows:n=>[["hour","azimuth_deg","elevation_deg","lit"],...n.path.map((e,t)=>[...e,n.lit[t]?1:0])],properties:n=>({sun_hours:n.sun_hours,first_light:n.first_light,last_light:n.last_light,possible_hours:n.possible_hours})},{name:"shadow",short:v`Shadow`,title:v`Shadow at a time`,icon:Un('<circle cx="17" cy="6" r="3"/><path d="M4 20h16M9 20V10h5v10M9 20l-5-3"/>'),places:0,time:"hour",hint:v`Move the time, or play the day.`,samples:!0,ask:(n,{date:e,clock:t,zone:i,trees:s})=>["shadow",{time:`${e}T${t}`,zone:i,trees:s}],change:{title:v`What the plan changes`,names:[v`in shadow before and after`,v`lit before and after`,v`lit only after`,v`lit only before`],gain:n=>v`${n} points gain the sun`,loss:n=>v`${n} points lose the sun`,of:Gu},between:{title:v`Between the two times`,names:[v`in shadow at both times`,v`lit at both times`,v`lit only at the second time`,v`lit only at the first time`],gain:n=>v`${n} points gain the sun`,loss:n=>v`${n} points lose the sun`,of:(n,{before:e,time:t})=>v`from ${e.time.replace("T"," ")} to ${t.replace("T"," ")}, of ${n} points of the cloud.`},show(n,e){e.answer=n.certainty?Ol(v`How likely it is lit`,["0 %","100 %"]):yu(n),e.light(n),e.values(new Uint8Array(n.probabilities??n.body)),n.lit_share=n.lit/Math.max(n.points,1);let t=n.elevation_deg>0;return`<p class="verdict">${t?Ou(n)+v`${gi(n.lit,n.points)} is lit`:v`The sun is below the horizon`}</p><p class="note">${v`of the points of the cloud, ${Ie(n.time.replace("T"," "))}.`} ${n.isFirst?Uu(n):""}</p>`+_i([...n.tells_unproven&&t?[[v`Lit, but unproven`,gi(n.unproven,n.points)]]:[],[v`Azimuth of the sun`,`${ke(n.azimuth_deg,1)}\xB0`],[v`Elevation of the sun`,`${ke(n.elevation_deg,1)}\xB0`]])+zu(n,[v`lit`,v`in shadow`])},rows:n=>[["time","azimuth_deg","elevation_deg","lit_share"],[n.time,n.azimuth_deg,n.elevation_deg,n.lit_share],...Bu(n)]},{name:"around",short:v`Sky`,title:v`Sky and space here`,icon:Un('<path d="M3 18a9 9 0 0 1 18 0"/><path d="M3 18h4v-5h4v5h3v-8h4v8h3"/>'),height:[v`Height above the clicked point`,1.7],places:1,hint:v`Click a place to measure its sky view and the space that is visible from it.`,ask:([n])=>["around",{place:n}],show(n){let{isovist:e}=n;return{html:`<p class="verdict">${v`Sky view factor ${ke(n.sky_view_factor,2)}`}</p><p class="note">${v`1 under a free sky, 0 without any sky.`}</p><figure id="panorama"><figcaption>${v`Panorama from north to north: sky blue, near dark, far light`}</figcaption></figure><figure>${Lu(n)}<figcaption>${v`Plan of the visible space at the height of the eye`}</figcaption></figure>`+_i([[v`Sky openness`,ke(n.sky_openness,3)],[v`Visible area in plan`,`${tt(Math.round(e.plan_area_m2))} m\xB2`],[v`Visible volume up to obstacles`,`${tt(Math.round(e.blocked_volume_m3))} m\xB3`],...e.openness>0?[[v`With open directions, up to ${ke(e.range_max_m,0)} m`,`${tt(Math.round(e.volume_m3))} m\xB3`],[v`Share of open directions`,gi(e.openness,1)]]:[],[v`Farthest view in plan`,Qt(e.plan_range_max_m,1)],[v`Nearest obstacle in plan`,Qt(e.plan_range_min_m,1)]]),after:t=>t.querySelector("#panorama").prepend(Du(new Uint8Array(n.body),n.panorama))}},rows:n=>[["measure","value"],["sky_view_factor",n.sky_view_factor],["sky_openness",n.sky_openness],...Object.entries(n.isovist)],properties:n=>({sky_view_factor:n.sky_view_factor,sky_openness:n.sky_openness,...n.isovist})},{name:"who",short:v`Seen from`,title:v`Who sees this`,icon:Un('<circle cx="12" cy="12" r="2.500"/><path d="M4 7V4h3M20 7V4h-3M4 17v3h3M20 17v3h-3M12 5v3M12 16v3M5 12h3M16 12h3"/>'),height:[v`Height above the clicked point`,.1],places:1,hint:v`Click a target to see from where people can see it.`,ask:([n])=>["who",{place:n}],show(n,e){e.cells(n);let t=n.visible?v`Seen from ${tt(Math.round(n.visible_m2))} m²`:v`No ground is known that sees it`,i=n.unproven?`${v`From ${tt(n.unproven)} cells nothing is in the way, but no pulse proves it.`} `:"",s=n.visible?v`of ground, by eyes 1.7 m above it.`:i+v`Where few points tell of a surface, a place on it may lie just inside it: ask again from higher above the clicked point.`;return`<p class="verdict">${t}</p><p class="note">${s}</p>${Fu(n,v`Cells`)}`},rows:n=>[["answer","cells"],["visible",n.visible],["unproven",n.unproven],["blocked",n.blocked]],properties:({visible_m2:n,visible:e,unproven:t,blocked:i})=>({visible_m2:n,visible:e,unproven:t,blocked:i})},{name:"roof",short:v`Roof`,title:v`Solar energy of a roof`,icon:Un('<path d="M3 19 8 7h13l-5 12z"/><path d="M5.500 13h13M10 19l5-12"/>'),places:1,hint:v`Click a roof to see what sun and sky send to its plane in a year of clear sky.`,ask:([n])=>["roof",{place:n}],show(n,e){return e.plane(n),`<p class="verdict">${v`${tt(Math.round(n.radiation_kwh/100)*100)} kWh a year`}</p><p class="note">${v`is the solar energy received by ${ke(n.panel_area_m2,0)} m² of panels from sun and sky, not electricity: panels turn a part of it into that. It is for a sky without clouds, an upper bound. With a file of weather, the command below gives less.`}</p>`+_i([[v`Received by a square metre`,`${tt(Math.round(n.kwh_m2))} kWh`],...Nu(n.interval_kwh_m2,t=>tt(Math.round(t)),"kWh"),[v`Without any shade`,`${tt(Math.round(n.free_kwh_m2))} kWh`],[v`Lost by shade, each panel for itself`,gi(n.min_loss,1)],[v`Lost by shade, panels in strings`,gi(n.max_loss,1)],[v`Tilt`,`${ke(n.tilt_deg,0)}\xB0`],[v`Faces`,n.azimuth_deg===null?v`up`:v`${ke(n.azimuth_deg,0)}° from north`],[v`Area of the plane`,`${ke(n.area_m2,1)} m\xB2`],[v`Plane`,v`${n.plane} of ${n.planes}`]])+`<h3>${v`Solar energy received in each month, kWh/m²`}</h3><figure>${Pu(n.months_kwh_m2)}</figure>`},rows:n=>[["month","kwh_m2"],...n.months_kwh_m2.map((e,t)=>[t+1,e])],properties:({plane:n,radiation_kwh:e,kwh_m2:t,free_kwh_m2:i,min_loss:s,max_loss:r,tilt_deg:o,azimuth_deg:a,area_m2:l})=>({plane:n,radiation_kwh:e,kwh_m2:t,free_kwh_m2:i,min_loss:s,max_loss:r,tilt_deg:o,azimuth_deg:a,area_m2:l})},{name:"sun_area",short:v`Sun hours`,title:v`Sun hours of an area`,change:!0,icon:Un('<path d="M4 8 13 4l7 8-5 8-9-3z"/><circle cx="12.500" cy="11.500" r="2"/>'),places:1/0,time:"date",hint:v`Click the corners of the area.`,ask:(n,{date:e,zone:t,trees:i})=>["sun_area",{corners:n.map(([s,r])=>[s,r]),date:e,zone:t,trees:i}],show(n,e){return e.hourCells(n),`<p class="verdict">${v`${ke(n.mean_hours,1)} hours of sun`}</p><p class="note">${v`on average on ${Ie(e.time.date)}, of ${ke(n.possible_hours,1)} possible hours.`}</p>`+_i([[v`Least`,`${ke(n.min_hours,1)} h`],[v`Most`,`${ke(n.max_hours,1)} h`],[v`Ground in the area`,`${tt(n.area_m2)} m\xB2`],[v`Cells`,v`${tt(n.cells)} of ${n.cell_m} m`]])},rows:(n,e)=>{let t=new Float32Array(n.body);return[["x","y","z","sun_hours"],...Array.from({length:t.length/4},(i,s)=>[...e.toFile([t[4*s],t[4*s+1],t[4*s+2]]),t[4*s+3].toFixed(3)])]},properties:({mean_hours:n,min_hours:e,max_hours:t,area_m2:i})=>({mean_hours:n,min_hours:e,max_hours:t,area_m2:i}),geometry:n=>["Polygon",[[...n,n[0]]]]},{name:"plan",short:v`Plan`,title:v`Plan buildings`,icon:Un('<path d="M4 20V9l6-4 6 4v11zM8 20v-5h4v5M19 4v6M16 7h6"/>'),places:1/0,hint:v`Draw or load what is planned, clear what goes; then ask again.`}],qi=[{name:"measure",title:v`Measure`,places:1/0,hint:v`Click places to measure between them.`},{name:"cut",title:v`Show a part`,places:2,hint:v`Click two corners, or move the heights.`},{name:"crs",title:v`The cloud, and how it is read`,places:0,hint:""}];var L=n=>document.getElementById(n),jn=document.documentElement,it=L("view"),wm=({name:n})=>n==="look"||n==="shadow"&&He.suns.length||n==="seen"&&He.viewpoints.length,wt=He?zl.filter(wm):zl,po=n=>[...wt,...qi].find(e=>e.name===n),x={scene:null,tool:wt[0],places:[],marks:[],answer:null,time:{date:"",zone:"UTC",minutes:780,trees:"opaque"},isSure:!1,compared:null,last:null};window.belvedere=x;function Mm(){let{tool:n}=x;return n.height?(n.above??=n.height[1],`<div class="field"><label for="above">${n.height[0]}</label><span><input id="above" type="number" step="0.1" value="${n.above}"> m</span></div>`):""}function xt(n,e){let t=L("card");t.hidden=!1,t.innerHTML=`<header><h2>${Ie(x.tool.title)}</h2><button aria-label="${v`Close`}" title="${v`Close`} (Esc)">\xD7</button></header>${Mm()}${n}`,t.querySelector("header button").onclick=()=>x.choose(wt[0].name);let i=t.querySelector("#above");i&&(i.onchange=()=>{let s=Number.parseFloat(i.value);Number.isFinite(s)&&(x.tool.above=s,x.places.forEach((r,o)=>{o===0&&(r.local=Bl(r.clicked,s))}),x.last&&x.ask())}),e?.(t)}var Bl=([n,e,t],i)=>[n,e,t+i],mo=({length:n})=>`${n===1?v`1 corner.`:v`${n} corners.`} ${n<3?v`Click more.`:v`Click more, or go on with these.`}`,Xi=({remarks:n=[]})=>n.map(e=>{let{key:t,severity:i}=e,s=jh(e),r=/^\S+\.\w+:/.test(s)?s:s[0].toUpperCase()+s.slice(1);return`<p class="remark ${i}" data-key="${Ie(t)}">${i==="warning"?"\u26A0 ":""}${Ie(r)}.</p>`}).join("");var Pi={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},Ii={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},fd=0,fc=1,pd=2;var Cr=1,md=2,Vs=3,Li=0,jt=1,dn=2,ts=0,Gs=1,pc=2,mc=3,gc=4,gd=5;var ns=100,_d=101,vd=102,xd=103,yd=104,bd=200,Sd=201,wd=202,Md=203,_c=204,vc=205,Ad=206,Td=207,Ed=208,Cd=209,Rd=210,Pd=211,Id=212,Ld=213,Dd=214,Bo=0,Vo=1,Go=2,Ps=3,Ho=4,Wo=5,$o=6,qo=7,xc=0,Nd=1,kd=2,Gn=0,yc=1,bc=2,Sc=3,wc=4,Mc=5,Ac=6,Tc=7;var Ec=300,is=301,Hs=302,ma=303,ga=304,Xo=1e3,zn=1001,Yo=1002,yt=1003,Od=1004;var Rr=1005;var Xt=1006,_a=1007;var oi=1008;var Ht=1009,Cc=1010,Rc=1011,Ws=1012,va=1013,In=1014,Ln=1015,Dn=1016,xa=1017,ya=1018,ss=1020,Pc=35902,Ic=35899,Lc=1021,Dc=1022,tn=1023,ii=1026,ai=1027,Nc=1028,ba=1029,Di=1030,Sa=1031;var wa=1033,Pr=33776,Ir=33777,Lr=33778,Dr=33779,Ma=35840,Aa=35841,Ta=35842,Ea=35843,Ca=36196,Ra=37492,Pa=37496,Ia=37488,La=37489,Nr=37490,Da=37491,Na=37808,ka=37809,Oa=37810,Ua=37811,Fa=37812,za=37813,Ba=37814,Va=37815,Ga=37816,Ha=37817,Wa=37818,$a=37819,qa=37820,Xa=37821,Ya=36492,Za=36494,ja=36495,Ka=36283,Ja=36284,kr=36285,Qa=36286;var dr=2300,Zo=2301,Fo=2302,oc=2303,ac=2400,lc=2401,cc=2402;var Ud=3200;var kc=0,Fd=1,li="",an="srgb",fr="srgb-linear",pr="linear",st="srgb";var zo=7680;var zd=519,Bd=512,Vd=513,Gd=514,Oc=515,Hd=516,Wd=517,Uc=518,Fc=519,$d=35044;var Hn="300 es",bn=2e3,mr=2001;function Am(n){for(let e=n.length-1;e>=0;--e)if(n[e]>=65535)return!0;return!1}function Tm(n){return ArrayBuffer.isView(n)&&!(n instanceof DataView)}function gr(n){return document.createElementNS("http://www.w3.org/1999/xhtml",n)}function qd(){let n=gr("canvas");return n.style.display="block",n}var Hu={},Is=null;function zc(...n){let e="THREE."+n.shift();Is?Is("log",e,...n):console.log(e,...n)}function Xd(n){let e=n[0];if(typeof e=="string"&&e.startsWith("TSL:")){let t=n[1];t&&t.isStackTrace?n[0]+=" "+t.getLocation():n[1]='Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.'}return n}function Le(...n){n=Xd(n);let e="THREE."+n.shift();if(Is)Is("warn",e,...n);else{let t=n[0];t&&t.isStackTrace?console.warn(t.getError(e)):console.warn(e,...n)}}function Oe(...n){n=Xd(n);let e="THREE."+n.shift();if(Is)Is("error",e,...n);else{let t=n[0];t&&t.isStackTrace?console.error(t.getError(e)):console.error(e,...n)}}function cr(...n){let e=n.join(" ");e in Hu||(Hu[e]=!0,Le(...n))}function Yd(n,e,t){return new Promise(function(i,s){function r(){switch(n.clientWaitSync(e,n.SYNC_FLUSH_COMMANDS_BIT,0)){case n.WAIT_FAILED:s();break;case n.TIMEOUT_EXPIRED:setTimeout(r,t);break;default:i()}}setTimeout(r,t)})}var Zd={[Bo]:Bo,[Go]:$o,[Ho]:Ho,[Ps]:Wo,[Vo]:Vo,[$o]:Go,[qo]:qo,[Wo]:Ps},Rn=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let i=this._listeners;i[e]===void 0&&(i[e]=[]),i[e].indexOf(t)===-1&&i[e].push(t)}hasEventListener(e,t){let i=this._listeners;return i===void 0?!1:i[e]!==void 0&&i[e].indexOf(t)!==-1}removeEventListener(e,t){let i=this._listeners;if(i===void 0)return;let s=i[e];if(s!==void 0){let r=s.indexOf(t);r!==-1&&s.splice(r,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let i=t[e.type];if(i!==void 0){e.target=this;let s=i.slice(0);for(let r=0,o=s.length;r<o;r++)s[r].call(this,e);e.target=null}}},Bt=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],Wu=1234567,hr=Math.PI/180,Ls=180/Math.PI;function $s(){let n=Math.random()*4294967295|0,e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,i=Math.random()*4294967295|0;return(Bt[n&255]+Bt[n>>8&255]+Bt[n>>16&255]+Bt[n>>24&255]+"-"+Bt[e&255]+Bt[e>>8&255]+"-"+Bt[e>>16&15|64]+Bt[e>>24&255]+"-"+Bt[t&63|128]+Bt[t>>8&255]+"-"+Bt[t>>16&255]+Bt[t>>24&255]+Bt[i&255]+Bt[i>>8&255]+Bt[i>>16&255]+Bt[i>>24&255]).toLowerCase()}function Xe(n,e,t){return Math.max(e,Math.min(t,n))}function Bc(n,e){return(n%e+e)%e}function Em(n,e,t,i,s){return i+(n-e)*(s-i)/(t-e)}function Cm(n,e,t){return n!==e?(t-n)/(e-n):0}function ur(n,e,t){return(1-t)*n+t*e}function Rm(n,e,t,i){return ur(n,e,1-Math.exp(-t*i))}function Pm(n,e=1){return e-Math.abs(Bc(n,e*2)-e)}function Im(n,e,t){return n<=e?0:n>=t?1:(n=(n-e)/(t-e),n*n*(3-2*n))}function Lm(n,e,t){return n<=e?0:n>=t?1:(n=(n-e)/(t-e),n*n*n*(n*(n*6-15)+10))}function Dm(n,e){return n+Math.floor(Math.random()*(e-n+1))}function Nm(n,e){return n+Math.random()*(e-n)}function km(n){return n*(.5-Math.random())}function Om(n){n!==void 0&&(Wu=n);let e=Wu+=1831565813;return e=Math.imul(e^e>>>15,e|1),e^=e+Math.imul(e^e>>>7,e|61),((e^e>>>14)>>>0)/4294967296}function Um(n){return n*hr}function Fm(n){return n*Ls}function zm(n){return n>0&&Number.isInteger(n)&&2**Math.round(Math.log2(n))===n}function Bm(n){return Math.pow(2,Math.ceil(Math.log(n)/Math.LN2))}function Vc(n){return Math.pow(2,Math.floor(Math.log(n)/Math.LN2))}function Vm(n,e,t,i,s){let r=Math.cos,o=Math.sin,a=r(t/2),l=o(t/2),c=r((e+i)/2),h=o((e+i)/2),d=r((e-i)/2),u=o((e-i)/2),f=r((i-e)/2),g=o((i-e)/2);switch(s){case"XYX":n.set(a*h,l*d,l*u,a*c);break;case"YZY":n.set(l*u,a*h,l*d,a*c);break;case"ZXZ":n.set(l*d,l*u,a*h,a*c);break;case"XZX":n.set(a*h,l*g,l*f,a*c);break;case"YXY":n.set(l*f,a*h,l*g,a*c);break;case"ZYZ":n.set(l*g,l*f,a*h,a*c);break;default:Le("MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function Gc(n){switch(n.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function jd(n,e){if(e.constructor===Float32Array)return n;let t=Gc(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.max(n/t,-1)}function Kd(n,e){if(e.constructor===Float32Array)return n;let t=Gc(e);if(t===void 0)throw new Error("THREE.MathUtils: Invalid component type.");return Math.round(n*t)}var Hc={DEG2RAD:hr,RAD2DEG:Ls,generateUUID:$s,clamp:Xe,euclideanModulo:Bc,mapLinear:Em,inverseLerp:Cm,lerp:ur,damp:Rm,pingpong:Pm,smoothstep:Im,smootherstep:Lm,randInt:Dm,randFloat:Nm,randFloatSpread:km,seededRandom:Om,degToRad:Um,radToDeg:Fm,isPowerOfTwo:zm,ceilPowerOfTwo:Bm,floorPowerOfTwo:Vc,setQuaternionFromProperEuler:Vm,normalize:Kd,denormalize:jd},De=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw new Error("THREE.Vector2: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw new Error("THREE.Vector2: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,i=this.y,s=e.elements;return this.x=s[0]*t+s[3]*i+s[6],this.y=s[1]*t+s[4]*i+s[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=Xe(this.x,e.x,t.x),this.y=Xe(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=Xe(this.x,e,t),this.y=Xe(this.y,e,t),this}clampLength(e,t){let i=this.length();return this.divideScalar(i||1).multiplyScalar(Xe(i,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let i=this.dot(e)/t;return Math.acos(Xe(i,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,i=this.y-e.y;return t*t+i*i}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,i){return this.x=e.x+(t.x-e.x)*i,this.y=e.y+(t.y-e.y)*i,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let i=Math.cos(t),s=Math.sin(t),r=this.x-e.x,o=this.y-e.y;return this.x=r*i-o*s+e.x,this.y=r*s+o*i+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},cn=class{constructor(e=0,t=0,i=0,s=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=i,this._w=s}static slerpFlat(e,t,i,s,r,o,a){let l=i[s+0],c=i[s+1],h=i[s+2],d=i[s+3],u=r[o+0],f=r[o+1],g=r[o+2],w=r[o+3];if(d!==w||l!==u||c!==f||h!==g){let p=l*u+c*f+h*g+d*w;p<0&&(u=-u,f=-f,g=-g,w=-w,p=-p);let m=1-a;if(p<.9995){let S=Math.acos(p),R=Math.sin(S);m=Math.sin(m*S)/R,a=Math.sin(a*S)/R,l=l*m+u*a,c=c*m+f*a,h=h*m+g*a,d=d*m+w*a}else{l=l*m+u*a,c=c*m+f*a,h=h*m+g*a,d=d*m+w*a;let S=1/Math.sqrt(l*l+c*c+h*h+d*d);l*=S,c*=S,h*=S,d*=S}}e[t]=l,e[t+1]=c,e[t+2]=h,e[t+3]=d}static multiplyQuaternionsFlat(e,t,i,s,r,o){let a=i[s],l=i[s+1],c=i[s+2],h=i[s+3],d=r[o],u=r[o+1],f=r[o+2],g=r[o+3];return e[t]=a*g+h*d+l*f-c*u,e[t+1]=l*g+h*u+c*d-a*f,e[t+2]=c*g+h*f+a*u-l*d,e[t+3]=h*g-a*d-l*u-c*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,i,s){return this._x=e,this._y=t,this._z=i,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let i=e._x,s=e._y,r=e._z,o=e._order,a=Math.cos,l=Math.sin,c=a(i/2),h=a(s/2),d=a(r/2),u=l(i/2),f=l(s/2),g=l(r/2);switch(o){case"XYZ":this._x=u*h*d+c*f*g,this._y=c*f*d-u*h*g,this._z=c*h*g+u*f*d,this._w=c*h*d-u*f*g;break;case"YXZ":this._x=u*h*d+c*f*g,this._y=c*f*d-u*h*g,this._z=c*h*g-u*f*d,this._w=c*h*d+u*f*g;break;case"ZXY":this._x=u*h*d-c*f*g,this._y=c*f*d+u*h*g,this._z=c*h*g+u*f*d,this._w=c*h*d-u*f*g;break;case"ZYX":this._x=u*h*d-c*f*g,this._y=c*f*d+u*h*g,this._z=c*h*g-u*f*d,this._w=c*h*d+u*f*g;break;case"YZX":this._x=u*h*d+c*f*g,this._y=c*f*d+u*h*g,this._z=c*h*g-u*f*d,this._w=c*h*d-u*f*g;break;case"XZY":this._x=u*h*d-c*f*g,this._y=c*f*d-u*h*g,this._z=c*h*g+u*f*d,this._w=c*h*d+u*f*g;break;default:Le("Quaternion: .setFromEuler() encountered an unknown order: "+o)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let i=t/2,s=Math.sin(i);return this._x=e.x*s,this._y=e.y*s,this._z=e.z*s,this._w=Math.cos(i),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,i=t[0],s=t[4],r=t[8],o=t[1],a=t[5],l=t[9],c=t[2],h=t[6],d=t[10],u=i+a+d;if(u>0){let f=.5/Math.sqrt(u+1);this._w=.25/f,this._x=(h-l)*f,this._y=(r-c)*f,this._z=(o-s)*f}else if(i>a&&i>d){let f=2*Math.sqrt(1+i-a-d);this._w=(h-l)/f,this._x=.25*f,this._y=(s+o)/f,this._z=(r+c)/f}else if(a>d){let f=2*Math.sqrt(1+a-i-d);this._w=(r-c)/f,this._x=(s+o)/f,this._y=.25*f,this._z=(l+h)/f}else{let f=2*Math.sqrt(1+d-i-a);this._w=(o-s)/f,this._x=(r+c)/f,this._y=(l+h)/f,this._z=.25*f}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let i=e.dot(t)+1;return i<1e-8?(i=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=i):(this._x=0,this._y=-e.z,this._z=e.y,this._w=i)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=i),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(Xe(this.dot(e),-1,1)))}rotateTowards(e,t){let i=this.angleTo(e);if(i===0)return this;let s=Math.min(1,t/i);return this.slerp(e,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x=this._x*e,this._y=this._y*e,this._z=this._z*e,this._w=this._w*e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let i=e._x,s=e._y,r=e._z,o=e._w,a=t._x,l=t._y,c=t._z,h=t._w;return this._x=i*h+o*a+s*c-r*l,this._y=s*h+o*l+r*a-i*c,this._z=r*h+o*c+i*l-s*a,this._w=o*h-i*a-s*l-r*c,this._onChangeCallback(),this}slerp(e,t){let i=e._x,s=e._y,r=e._z,o=e._w,a=this.dot(e);a<0&&(i=-i,s=-s,r=-r,o=-o,a=-a);let l=1-t;if(a<.9995){let c=Math.acos(a),h=Math.sin(c);l=Math.sin(l*c)/h,t=Math.sin(t*c)/h,this._x=this._x*l+i*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+o*t,this._onChangeCallback()}else this._x=this._x*l+i*t,this._y=this._y*l+s*t,this._z=this._z*l+r*t,this._w=this._w*l+o*t,this.normalize();return this}slerpQuaternions(e,t,i){return this.copy(e).slerp(t,i)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),i=Math.random(),s=Math.sqrt(1-i),r=Math.sqrt(i);return this.set(s*Math.sin(e),s*Math.cos(e),r*Math.sin(t),r*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},O=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,i=0){this.x=e,this.y=t,this.z=i}set(e,t,i){return i===void 0&&(i=this.z),this.x=e,this.y=t,this.z=i,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw new Error("THREE.Vector3: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("THREE.Vector3: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion($u.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion($u.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,i=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[3]*i+r[6]*s,this.y=r[1]*t+r[4]*i+r[7]*s,this.z=r[2]*t+r[5]*i+r[8]*s,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,i=this.y,s=this.z,r=e.elements,o=1/(r[3]*t+r[7]*i+r[11]*s+r[15]);return this.x=(r[0]*t+r[4]*i+r[8]*s+r[12])*o,this.y=(r[1]*t+r[5]*i+r[9]*s+r[13])*o,this.z=(r[2]*t+r[6]*i+r[10]*s+r[14])*o,this}applyQuaternion(e){let t=this.x,i=this.y,s=this.z,r=e.x,o=e.y,a=e.z,l=e.w,c=2*(o*s-a*i),h=2*(a*t-r*s),d=2*(r*i-o*t);return this.x=t+l*c+o*d-a*h,this.y=i+l*h+a*c-r*d,this.z=s+l*d+r*h-o*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,i=this.y,s=this.z,r=e.elements;return this.x=r[0]*t+r[4]*i+r[8]*s,this.y=r[1]*t+r[5]*i+r[9]*s,this.z=r[2]*t+r[6]*i+r[10]*s,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=Xe(this.x,e.x,t.x),this.y=Xe(this.y,e.y,t.y),this.z=Xe(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=Xe(this.x,e,t),this.y=Xe(this.y,e,t),this.z=Xe(this.z,e,t),this}clampLength(e,t){let i=this.length();return this.divideScalar(i||1).multiplyScalar(Xe(i,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,i){return this.x=e.x+(t.x-e.x)*i,this.y=e.y+(t.y-e.y)*i,this.z=e.z+(t.z-e.z)*i,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let i=e.x,s=e.y,r=e.z,o=t.x,a=t.y,l=t.z;return this.x=s*l-r*a,this.y=r*o-i*l,this.z=i*a-s*o,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let i=e.dot(this)/t;return this.copy(e).multiplyScalar(i)}projectOnPlane(e){return Vl.copy(this).projectOnVector(e),this.sub(Vl)}reflect(e){return this.sub(Vl.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let i=this.dot(e)/t;return Math.acos(Xe(i,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,i=this.y-e.y,s=this.z-e.z;return t*t+i*i+s*s}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,i){let s=Math.sin(t)*e;return this.x=s*Math.sin(i),this.y=Math.cos(t)*e,this.z=s*Math.cos(i),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,i){return this.x=e*Math.sin(t),this.y=i,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),i=this.setFromMatrixColumn(e,1).length(),s=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=i,this.z=s,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,i=Math.sqrt(1-t*t);return this.x=i*Math.cos(e),this.y=t,this.z=i*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},Vl=new O,$u=new cn,Ue=class{static{this.prototype.isMatrix3=!0}constructor(e,t,i,s,r,o,a,l,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,i,s,r,o,a,l,c)}set(e,t,i,s,r,o,a,l,c){let h=this.elements;return h[0]=e,h[1]=s,h[2]=a,h[3]=t,h[4]=r,h[5]=l,h[6]=i,h[7]=o,h[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,i=e.elements;return t[0]=i[0],t[1]=i[1],t[2]=i[2],t[3]=i[3],t[4]=i[4],t[5]=i[5],t[6]=i[6],t[7]=i[7],t[8]=i[8],this}extractBasis(e,t,i){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),i.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let i=e.elements,s=t.elements,r=this.elements,o=i[0],a=i[3],l=i[6],c=i[1],h=i[4],d=i[7],u=i[2],f=i[5],g=i[8],w=s[0],p=s[3],m=s[6],S=s[1],R=s[4],T=s[7],M=s[2],E=s[5],_=s[8];return r[0]=o*w+a*S+l*M,r[3]=o*p+a*R+l*E,r[6]=o*m+a*T+l*_,r[1]=c*w+h*S+d*M,r[4]=c*p+h*R+d*E,r[7]=c*m+h*T+d*_,r[2]=u*w+f*S+g*M,r[5]=u*p+f*R+g*E,r[8]=u*m+f*T+g*_,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],i=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],h=e[8];return t*o*h-t*a*c-i*r*h+i*a*l+s*r*c-s*o*l}invert(){let e=this.elements,t=e[0],i=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],h=e[8],d=h*o-a*c,u=a*l-h*r,f=c*r-o*l,g=t*d+i*u+s*f;if(g===0)return this.set(0,0,0,0,0,0,0,0,0);let w=1/g;return e[0]=d*w,e[1]=(s*c-h*i)*w,e[2]=(a*i-s*o)*w,e[3]=u*w,e[4]=(h*t-s*l)*w,e[5]=(s*r-a*t)*w,e[6]=f*w,e[7]=(i*l-c*t)*w,e[8]=(o*t-i*r)*w,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,i,s,r,o,a){let l=Math.cos(r),c=Math.sin(r);return this.set(i*l,i*c,-i*(l*o+c*a)+o+e,-s*c,s*l,-s*(-c*o+l*a)+a+t,0,0,1),this}scale(e,t){return cr("Matrix3: .scale() is deprecated. Use .makeScale() instead."),this.premultiply(Gl.makeScale(e,t)),this}rotate(e){return cr("Matrix3: .rotate() is deprecated. Use .makeRotation() instead."),this.premultiply(Gl.makeRotation(-e)),this}translate(e,t){return cr("Matrix3: .translate() is deprecated. Use .makeTranslation() instead."),this.premultiply(Gl.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),i=Math.sin(e);return this.set(t,-i,0,i,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,i=e.elements;for(let s=0;s<9;s++)if(t[s]!==i[s])return!1;return!0}fromArray(e,t=0){for(let i=0;i<9;i++)this.elements[i]=e[i+t];return this}toArray(e=[],t=0){let i=this.elements;return e[t]=i[0],e[t+1]=i[1],e[t+2]=i[2],e[t+3]=i[3],e[t+4]=i[4],e[t+5]=i[5],e[t+6]=i[6],e[t+7]=i[7],e[t+8]=i[8],e}clone(){return new this.constructor().fromArray(this.elements)}},Gl=new Ue,qu=new Ue().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),Xu=new Ue().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function Gm(){let n={enabled:!0,workingColorSpace:fr,spaces:{},convert:function(s,r,o){return this.enabled===!1||r===o||!r||!o||(this.spaces[r].transfer===st&&(s.r=ni(s.r),s.g=ni(s.g),s.b=ni(s.b)),this.spaces[r].primaries!==this.spaces[o].primaries&&(s.applyMatrix3(this.spaces[r].toXYZ),s.applyMatrix3(this.spaces[o].fromXYZ)),this.spaces[o].transfer===st&&(s.r=Rs(s.r),s.g=Rs(s.g),s.b=Rs(s.b))),s},workingToColorSpace:function(s,r){return this.convert(s,this.workingColorSpace,r)},colorSpaceToWorking:function(s,r){return this.convert(s,r,this.workingColorSpace)},getPrimaries:function(s){return this.spaces[s].primaries},getTransfer:function(s){return s===li?pr:this.spaces[s].transfer},getToneMappingMode:function(s){return this.spaces[s].outputColorSpaceConfig.toneMappingMode||"standard"},getLuminanceCoefficients:function(s,r=this.workingColorSpace){return s.fromArray(this.spaces[r].luminanceCoefficients)},define:function(s){Object.assign(this.spaces,s)},_getMatrix:function(s,r,o){return s.copy(this.spaces[o].fromXYZ).multiply(this.spaces[r].toXYZ)},_getDrawingBufferColorSpace:function(s){return this.spaces[s].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(s=this.workingColorSpace){return this.spaces[s].workingColorSpaceConfig.unpackColorSpace}},e=[.64,.33,.3,.6,.15,.06],t=[.2126,.7152,.0722],i=[.3127,.329];return n.define({[fr]:{primaries:e,whitePoint:i,transfer:pr,toXYZ:qu,fromXYZ:Xu,luminanceCoefficients:t,workingColorSpaceConfig:{unpackColorSpace:an},outputColorSpaceConfig:{drawingBufferColorSpace:an}},[an]:{primaries:e,whitePoint:i,transfer:st,toXYZ:qu,fromXYZ:Xu,luminanceCoefficients:t,outputColorSpaceConfig:{drawingBufferColorSpace:an}}}),n}var Ke=Gm();function ni(n){return n<.04045?n*.0773993808:Math.pow(n*.9478672986+.0521327014,2.4)}function Rs(n){return n<.0031308?n*12.92:1.055*Math.pow(n,.41666)-.055}var gs,jo=class{static getDataURL(e,t="image/png"){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>"u")return e.src;let i;if(e instanceof HTMLCanvasElement)i=e;else{gs===void 0&&(gs=gr("canvas")),gs.width=e.width,gs.height=e.height;let s=gs.getContext("2d");e instanceof ImageData?s.putImageData(e,0,0):s.drawImage(e,0,0,e.width,e.height),i=gs}return i.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<"u"&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&e instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&e instanceof ImageBitmap){let t=gr("canvas");t.width=e.width,t.height=e.height;let i=t.getContext("2d");i.drawImage(e,0,0,e.width,e.height);let s=i.getImageData(0,0,e.width,e.height),r=s.data;for(let o=0;o<r.length;o++)r[o]=ni(r[o]/255)*255;return i.putImageData(s,0,0),t}else if(e.data){let t=e.data.slice(0);for(let i=0;i<t.length;i++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[i]=Math.floor(ni(t[i]/255)*255):t[i]=ni(t[i]);return{data:t,width:e.width,height:e.height}}else return Le("ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),e}},Hm=0,Ds=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:Hm++}),this.uuid=$s(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<"u"&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<"u"&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t!==null?e.set(t.width||0,t.height||0,t.depth||0):e.set(0,0,0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let i={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let o=0,a=s.length;o<a;o++)s[o].isDataTexture?r.push(Hl(s[o].image)):r.push(Hl(s[o]))}else r=Hl(s);i.url=r}return t||(e.images[this.uuid]=i),i}};function Hl(n){return typeof HTMLImageElement<"u"&&n instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&n instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&n instanceof ImageBitmap?jo.getDataURL(n):n.data?{data:Array.from(n.data),width:n.width,height:n.height,type:n.data.constructor.name}:(Le("Texture: Unable to serialize Texture."),{})}var Wm=0,Wl=new O,en=class n extends Rn{constructor(e=n.DEFAULT_IMAGE,t=n.DEFAULT_MAPPING,i=zn,s=zn,r=Xt,o=oi,a=tn,l=Ht,c=n.DEFAULT_ANISOTROPY,h=li){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:Wm++}),this.uuid=$s(),this.name="",this.source=new Ds(e),this.mipmaps=[],this.mapping=t,this.channel=0,this.wrapS=i,this.wrapT=s,this.magFilter=r,this.minFilter=o,this.anisotropy=c,this.format=a,this.internalFormat=null,this.type=l,this.offset=new De(0,0),this.repeat=new De(1,1),this.center=new De(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new Ue,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=h,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(e&&e.depth&&e.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(Wl).x}get height(){return this.source.getSize(Wl).y}get depth(){return this.source.getSize(Wl).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let i=e[t];if(i===void 0){Le(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Le(`Texture.setValues(): property '${t}' does not exist.`);continue}s&&i&&s.isVector2&&i.isVector2||s&&i&&s.isVector3&&i.isVector3||s&&i&&s.isMatrix3&&i.isMatrix3?s.copy(i):this[t]=i}}toJSON(e){let t=e===void 0||typeof e=="string";if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let i={metadata:{version:4.7,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(i.userData=this.userData),t||(e.textures[this.uuid]=i),i}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(e){if(this.mapping!==Ec)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case Xo:e.x=e.x-Math.floor(e.x);break;case zn:e.x=e.x<0?0:1;break;case Yo:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x=e.x-Math.floor(e.x);break}if(e.y<0||e.y>1)switch(this.wrapT){case Xo:e.y=e.y-Math.floor(e.y);break;case zn:e.y=e.y<0?0:1;break;case Yo:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y=e.y-Math.floor(e.y);break}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};en.DEFAULT_IMAGE=null;en.DEFAULT_MAPPING=Ec;en.DEFAULT_ANISOTROPY=1;var vt=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,i=0,s=1){this.x=e,this.y=t,this.z=i,this.w=s}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,i,s){return this.x=e,this.y=t,this.z=i,this.w=s,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw new Error("THREE.Vector4: index is out of range: "+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("THREE.Vector4: index is out of range: "+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w!==void 0?e.w:1,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,i=this.y,s=this.z,r=this.w,o=e.elements;return this.x=o[0]*t+o[4]*i+o[8]*s+o[12]*r,this.y=o[1]*t+o[5]*i+o[9]*s+o[13]*r,this.z=o[2]*t+o[6]*i+o[10]*s+o[14]*r,this.w=o[3]*t+o[7]*i+o[11]*s+o[15]*r,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,i,s,r,l=e.elements,c=l[0],h=l[4],d=l[8],u=l[1],f=l[5],g=l[9],w=l[2],p=l[6],m=l[10];if(Math.abs(h-u)<.01&&Math.abs(d-w)<.01&&Math.abs(g-p)<.01){if(Math.abs(h+u)<.1&&Math.abs(d+w)<.1&&Math.abs(g+p)<.1&&Math.abs(c+f+m-3)<.1)return this.set(1,0,0,0),this;t=Math.PI;let R=(c+1)/2,T=(f+1)/2,M=(m+1)/2,E=(h+u)/4,_=(d+w)/4,A=(g+p)/4;return R>T&&R>M?R<.01?(i=0,s=.707106781,r=.707106781):(i=Math.sqrt(R),s=E/i,r=_/i):T>M?T<.01?(i=.707106781,s=0,r=.707106781):(s=Math.sqrt(T),i=E/s,r=A/s):M<.01?(i=.707106781,s=.707106781,r=0):(r=Math.sqrt(M),i=_/r,s=A/r),this.set(i,s,r,t),this}let S=Math.sqrt((p-g)*(p-g)+(d-w)*(d-w)+(u-h)*(u-h));return Math.abs(S)<.001&&(S=1),this.x=(p-g)/S,this.y=(d-w)/S,this.z=(u-h)/S,this.w=Math.acos((c+f+m-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=Xe(this.x,e.x,t.x),this.y=Xe(this.y,e.y,t.y),this.z=Xe(this.z,e.z,t.z),this.w=Xe(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=Xe(this.x,e,t),this.y=Xe(this.y,e,t),this.z=Xe(this.z,e,t),this.w=Xe(this.w,e,t),this}clampLength(e,t){let i=this.length();return this.divideScalar(i||1).multiplyScalar(Xe(i,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,i){return this.x=e.x+(t.x-e.x)*i,this.y=e.y+(t.y-e.y)*i,this.z=e.z+(t.z-e.z)*i,this.w=e.w+(t.w-e.w)*i,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},Ko=class extends Rn{constructor(e=1,t=1,i={}){super(),i=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:Xt,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},i),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=i.depth,this.scissor=new vt(0,0,e,t),this.scissorTest=!1,this.viewport=new vt(0,0,e,t),this.textures=[];let s=i.count;for(let r=0;r<s;r++)this.textures[r]=new en({width:e,height:t,depth:i.depth}),this.textures[r].isRenderTargetTexture=!0,this.textures[r].renderTarget=this;this._setTextureOptions(i),this.depthBuffer=i.depthBuffer,this.stencilBuffer=i.stencilBuffer,this.resolveColorBuffer=i.resolveColorBuffer,this.resolveDepthBuffer=i.resolveDepthBuffer,this.resolveStencilBuffer=i.resolveStencilBuffer,this.storeMultisampledColorBuffer=i.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=i.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=i.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=i.depthTexture,this.samples=i.samples,this.multiview=i.multiview,this.useArrayDepthTexture=i.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:Xt,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let i=0;i<this.textures.length;i++)this.textures[i].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,i=1){if(this.width!==e||this.height!==t||this.depth!==i){this.width=e,this.height=t,this.depth=i;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=e,this.textures[s].image.height=t,this.textures[s].image.depth=i,this.textures[s].isData3DTexture!==!0&&(this.textures[s].isArrayTexture=this.textures[s].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,i=e.textures.length;t<i;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let s=Object.assign({},e.textures[t].image);this.textures[t].source=new Ds(s)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null)if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture;else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:"dispose"})}},Yt=class extends Ko{constructor(e=1,t=1,i={}){super(e,t,i),this.isWebGLRenderTarget=!0}},_r=class extends en{constructor(e=null,t=1,i=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:i,depth:s},this.magFilter=yt,this.minFilter=yt,this.wrapR=zn,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}};var Jo=class extends en{constructor(e=null,t=1,i=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:i,depth:s},this.magFilter=yt,this.minFilter=yt,this.wrapR=zn,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}};var ut=class n{static{this.prototype.isMatrix4=!0}constructor(e,t,i,s,r,o,a,l,c,h,d,u,f,g,w,p){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,i,s,r,o,a,l,c,h,d,u,f,g,w,p)}set(e,t,i,s,r,o,a,l,c,h,d,u,f,g,w,p){let m=this.elements;return m[0]=e,m[4]=t,m[8]=i,m[12]=s,m[1]=r,m[5]=o,m[9]=a,m[13]=l,m[2]=c,m[6]=h,m[10]=d,m[14]=u,m[3]=f,m[7]=g,m[11]=w,m[15]=p,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new n().fromArray(this.elements)}copy(e){let t=this.elements,i=e.elements;return t[0]=i[0],t[1]=i[1],t[2]=i[2],t[3]=i[3],t[4]=i[4],t[5]=i[5],t[6]=i[6],t[7]=i[7],t[8]=i[8],t[9]=i[9],t[10]=i[10],t[11]=i[11],t[12]=i[12],t[13]=i[13],t[14]=i[14],t[15]=i[15],this}copyPosition(e){let t=this.elements,i=e.elements;return t[12]=i[12],t[13]=i[13],t[14]=i[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,i){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),i.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),i.setFromMatrixColumn(this,2),this)}makeBasis(e,t,i){return this.set(e.x,t.x,i.x,0,e.y,t.y,i.y,0,e.z,t.z,i.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,i=e.elements,s=1/_s.setFromMatrixColumn(e,0).length(),r=1/_s.setFromMatrixColumn(e,1).length(),o=1/_s.setFromMatrixColumn(e,2).length();return t[0]=i[0]*s,t[1]=i[1]*s,t[2]=i[2]*s,t[3]=0,t[4]=i[4]*r,t[5]=i[5]*r,t[6]=i[6]*r,t[7]=0,t[8]=i[8]*o,t[9]=i[9]*o,t[10]=i[10]*o,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,i=e.x,s=e.y,r=e.z,o=Math.cos(i),a=Math.sin(i),l=Math.cos(s),c=Math.sin(s),h=Math.cos(r),d=Math.sin(r);if(e.order==="XYZ"){let u=o*h,f=o*d,g=a*h,w=a*d;t[0]=l*h,t[4]=-l*d,t[8]=c,t[1]=f+g*c,t[5]=u-w*c,t[9]=-a*l,t[2]=w-u*c,t[6]=g+f*c,t[10]=o*l}else if(e.order==="YXZ"){let u=l*h,f=l*d,g=c*h,w=c*d;t[0]=u+w*a,t[4]=g*a-f,t[8]=o*c,t[1]=o*d,t[5]=o*h,t[9]=-a,t[2]=f*a-g,t[6]=w+u*a,t[10]=o*l}else if(e.order==="ZXY"){let u=l*h,f=l*d,g=c*h,w=c*d;t[0]=u-w*a,t[4]=-o*d,t[8]=g+f*a,t[1]=f+g*a,t[5]=o*h,t[9]=w-u*a,t[2]=-o*c,t[6]=a,t[10]=o*l}else if(e.order==="ZYX"){let u=o*h,f=o*d,g=a*h,w=a*d;t[0]=l*h,t[4]=g*c-f,t[8]=u*c+w,t[1]=l*d,t[5]=w*c+u,t[9]=f*c-g,t[2]=-c,t[6]=a*l,t[10]=o*l}else if(e.order==="YZX"){let u=o*l,f=o*c,g=a*l,w=a*c;t[0]=l*h,t[4]=w-u*d,t[8]=g*d+f,t[1]=d,t[5]=o*h,t[9]=-a*h,t[2]=-c*h,t[6]=f*d+g,t[10]=u-w*d}else if(e.order==="XZY"){let u=o*l,f=o*c,g=a*l,w=a*c;t[0]=l*h,t[4]=-d,t[8]=c*h,t[1]=u*d+w,t[5]=o*h,t[9]=f*d-g,t[2]=g*d-f,t[6]=a*h,t[10]=w*d+u}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose($m,e,qm)}lookAt(e,t,i){let s=this.elements;return rn.subVectors(e,t),rn.lengthSq()===0&&(rn.z=1),rn.normalize(),vi.crossVectors(i,rn),vi.lengthSq()===0&&(Math.abs(i.z)===1?rn.x+=1e-4:rn.z+=1e-4,rn.normalize(),vi.crossVectors(i,rn)),vi.normalize(),go.crossVectors(rn,vi),s[0]=vi.x,s[4]=go.x,s[8]=rn.x,s[1]=vi.y,s[5]=go.y,s[9]=rn.y,s[2]=vi.z,s[6]=go.z,s[10]=rn.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let i=e.elements,s=t.elements,r=this.elements,o=i[0],a=i[4],l=i[8],c=i[12],h=i[1],d=i[5],u=i[9],f=i[13],g=i[2],w=i[6],p=i[10],m=i[14],S=i[3],R=i[7],T=i[11],M=i[15],E=s[0],_=s[4],A=s[8],F=s[12],N=s[1],U=s[5],V=s[9],q=s[13],I=s[2],H=s[6],Z=s[10],W=s[14],ie=s[3],Y=s[7],te=s[11],ne=s[15];return r[0]=o*E+a*N+l*I+c*ie,r[4]=o*_+a*U+l*H+c*Y,r[8]=o*A+a*V+l*Z+c*te,r[12]=o*F+a*q+l*W+c*ne,r[1]=h*E+d*N+u*I+f*ie,r[5]=h*_+d*U+u*H+f*Y,r[9]=h*A+d*V+u*Z+f*te,r[13]=h*F+d*q+u*W+f*ne,r[2]=g*E+w*N+p*I+m*ie,r[6]=g*_+w*U+p*H+m*Y,r[10]=g*A+w*V+p*Z+m*te,r[14]=g*F+w*q+p*W+m*ne,r[3]=S*E+R*N+T*I+M*ie,r[7]=S*_+R*U+T*H+M*Y,r[11]=S*A+R*V+T*Z+M*te,r[15]=S*F+R*q+T*W+M*ne,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],i=e[4],s=e[8],r=e[12],o=e[1],a=e[5],l=e[9],c=e[13],h=e[2],d=e[6],u=e[10],f=e[14],g=e[3],w=e[7],p=e[11],m=e[15],S=l*f-c*u,R=a*f-c*d,T=a*u-l*d,M=o*f-c*h,E=o*u-l*h,_=o*d-a*h;return t*(w*S-p*R+m*T)-i*(g*S-p*M+m*E)+s*(g*R-w*M+m*_)-r*(g*T-w*E+p*_)}determinantAffine(){let e=this.elements,t=e[0],i=e[4],s=e[8],r=e[1],o=e[5],a=e[9],l=e[2],c=e[6],h=e[10];return t*(o*h-a*c)-i*(r*h-a*l)+s*(r*c-o*l)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,i){let s=this.elements;return e.isVector3?(s[12]=e.x,s[13]=e.y,s[14]=e.z):(s[12]=e,s[13]=t,s[14]=i),this}invert(){let e=this.elements,t=e[0],i=e[1],s=e[2],r=e[3],o=e[4],a=e[5],l=e[6],c=e[7],h=e[8],d=e[9],u=e[10],f=e[11],g=e[12],w=e[13],p=e[14],m=e[15],S=t*a-i*o,R=t*l-s*o,T=t*c-r*o,M=i*l-s*a,E=i*c-r*a,_=s*c-r*l,A=h*w-d*g,F=h*p-u*g,N=h*m-f*g,U=d*p-u*w,V=d*m-f*w,q=u*m-f*p,I=S*q-R*V+T*U+M*N-E*F+_*A;if(I===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let H=1/I;return e[0]=(a*q-l*V+c*U)*H,e[1]=(s*V-i*q-r*U)*H,e[2]=(w*_-p*E+m*M)*H,e[3]=(u*E-d*_-f*M)*H,e[4]=(l*N-o*q-c*F)*H,e[5]=(t*q-s*N+r*F)*H,e[6]=(p*T-g*_-m*R)*H,e[7]=(h*_-u*T+f*R)*H,e[8]=(o*V-a*N+c*A)*H,e[9]=(i*N-t*V-r*A)*H,e[10]=(g*E-w*T+m*S)*H,e[11]=(d*T-h*E-f*S)*H,e[12]=(a*F-o*U-l*A)*H,e[13]=(t*U-i*F+s*A)*H,e[14]=(w*R-g*M-p*S)*H,e[15]=(h*M-d*R+u*S)*H,this}scale(e){let t=this.elements,i=e.x,s=e.y,r=e.z;return t[0]*=i,t[4]*=s,t[8]*=r,t[1]*=i,t[5]*=s,t[9]*=r,t[2]*=i,t[6]*=s,t[10]*=r,t[3]*=i,t[7]*=s,t[11]*=r,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],i=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],s=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,i,s))}makeTranslation(e,t,i){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,i,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),i=Math.sin(e);return this.set(1,0,0,0,0,t,-i,0,0,i,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),i=Math.sin(e);return this.set(t,0,i,0,0,1,0,0,-i,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),i=Math.sin(e);return this.set(t,-i,0,0,i,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let i=Math.cos(t),s=Math.sin(t),r=1-i,o=e.x,a=e.y,l=e.z,c=r*o,h=r*a;return this.set(c*o+i,c*a-s*l,c*l+s*a,0,c*a+s*l,h*a+i,h*l-s*o,0,c*l-s*a,h*l+s*o,r*l*l+i,0,0,0,0,1),this}makeScale(e,t,i){return this.set(e,0,0,0,0,t,0,0,0,0,i,0,0,0,0,1),this}makeShear(e,t,i,s,r,o){return this.set(1,i,r,0,e,1,o,0,t,s,1,0,0,0,0,1),this}compose(e,t,i){let s=this.elements,r=t._x,o=t._y,a=t._z,l=t._w,c=r+r,h=o+o,d=a+a,u=r*c,f=r*h,g=r*d,w=o*h,p=o*d,m=a*d,S=l*c,R=l*h,T=l*d,M=i.x,E=i.y,_=i.z;return s[0]=(1-(w+m))*M,s[1]=(f+T)*M,s[2]=(g-R)*M,s[3]=0,s[4]=(f-T)*E,s[5]=(1-(u+m))*E,s[6]=(p+S)*E,s[7]=0,s[8]=(g+R)*_,s[9]=(p-S)*_,s[10]=(1-(u+w))*_,s[11]=0,s[12]=e.x,s[13]=e.y,s[14]=e.z,s[15]=1,this}decompose(e,t,i){let s=this.elements;e.x=s[12],e.y=s[13],e.z=s[14];let r=this.determinantAffine();if(r===0)return i.set(1,1,1),t.identity(),this;let o=_s.set(s[0],s[1],s[2]).length(),a=_s.set(s[4],s[5],s[6]).length(),l=_s.set(s[8],s[9],s[10]).length();r<0&&(o=-o),Tn.copy(this);let c=1/o,h=1/a,d=1/l;return Tn.elements[0]*=c,Tn.elements[1]*=c,Tn.elements[2]*=c,Tn.elements[4]*=h,Tn.elements[5]*=h,Tn.elements[6]*=h,Tn.elements[8]*=d,Tn.elements[9]*=d,Tn.elements[10]*=d,t.setFromRotationMatrix(Tn),i.x=o,i.y=a,i.z=l,this}makePerspective(e,t,i,s,r,o,a=bn,l=!1){let c=this.elements,h=2*r/(t-e),d=2*r/(i-s),u=(t+e)/(t-e),f=(i+s)/(i-s),g,w;if(l)g=r/(o-r),w=o*r/(o-r);else if(a===bn)g=-(o+r)/(o-r),w=-2*o*r/(o-r);else if(a===mr)g=-o/(o-r),w=-o*r/(o-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+a);return c[0]=h,c[4]=0,c[8]=u,c[12]=0,c[1]=0,c[5]=d,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=g,c[14]=w,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,i,s,r,o,a=bn,l=!1){let c=this.elements,h=2/(t-e),d=2/(i-s),u=-(t+e)/(t-e),f=-(i+s)/(i-s),g,w;if(l)g=1/(o-r),w=o/(o-r);else if(a===bn)g=-2/(o-r),w=-(o+r)/(o-r);else if(a===mr)g=-1/(o-r),w=-r/(o-r);else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+a);return c[0]=h,c[4]=0,c[8]=0,c[12]=u,c[1]=0,c[5]=d,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=g,c[14]=w,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,i=e.elements;for(let s=0;s<16;s++)if(t[s]!==i[s])return!1;return!0}fromArray(e,t=0){for(let i=0;i<16;i++)this.elements[i]=e[i+t];return this}toArray(e=[],t=0){let i=this.elements;return e[t]=i[0],e[t+1]=i[1],e[t+2]=i[2],e[t+3]=i[3],e[t+4]=i[4],e[t+5]=i[5],e[t+6]=i[6],e[t+7]=i[7],e[t+8]=i[8],e[t+9]=i[9],e[t+10]=i[10],e[t+11]=i[11],e[t+12]=i[12],e[t+13]=i[13],e[t+14]=i[14],e[t+15]=i[15],e}},_s=new O,Tn=new ut,$m=new O(0,0,0),qm=new O(1,1,1),vi=new O,go=new O,rn=new O,Yu=new ut,Zu=new cn,Mi=class n{constructor(e=0,t=0,i=0,s=n.DEFAULT_ORDER){this.isEuler=!0,this._x=e,this._y=t,this._z=i,this._order=s}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,i,s=this._order){return this._x=e,this._y=t,this._z=i,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,i=!0){let s=e.elements,r=s[0],o=s[4],a=s[8],l=s[1],c=s[5],h=s[9],d=s[2],u=s[6],f=s[10];switch(t){case"XYZ":this._y=Math.asin(Xe(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(-h,f),this._z=Math.atan2(-o,r)):(this._x=Math.atan2(u,c),this._z=0);break;case"YXZ":this._x=Math.asin(-Xe(h,-1,1)),Math.abs(h)<.9999999?(this._y=Math.atan2(a,f),this._z=Math.atan2(l,c)):(this._y=Math.atan2(-d,r),this._z=0);break;case"ZXY":this._x=Math.asin(Xe(u,-1,1)),Math.abs(u)<.9999999?(this._y=Math.atan2(-d,f),this._z=Math.atan2(-o,c)):(this._y=0,this._z=Math.atan2(l,r));break;case"ZYX":this._y=Math.asin(-Xe(d,-1,1)),Math.abs(d)<.9999999?(this._x=Math.atan2(u,f),this._z=Math.atan2(l,r)):(this._x=0,this._z=Math.atan2(-o,c));break;case"YZX":this._z=Math.asin(Xe(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-h,c),this._y=Math.atan2(-d,r)):(this._x=0,this._y=Math.atan2(a,f));break;case"XZY":this._z=Math.asin(-Xe(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(u,c),this._y=Math.atan2(a,r)):(this._x=Math.atan2(-h,f),this._y=0);break;default:Le("Euler: .setFromRotationMatrix() encountered an unknown order: "+t)}return this._order=t,i===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,i){return Yu.makeRotationFromQuaternion(e),this.setFromRotationMatrix(Yu,t,i)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return Zu.setFromEuler(this),this.setFromQuaternion(Zu,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};Mi.DEFAULT_ORDER="XYZ";var vr=class{constructor(){this.mask=1}set(e){this.mask=(1<<e|0)>>>0}enable(e){this.mask|=1<<e|0}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e|0}disable(e){this.mask&=~(1<<e|0)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return(this.mask&(1<<e|0))!==0}},Xm=0,ju=new O,vs=new cn,Kn=new ut,_o=new O,rr=new O,Ym=new O,Zm=new cn,Ku=new O(1,0,0),Ju=new O(0,1,0),Qu=new O(0,0,1),ed={type:"added"},jm={type:"removed"},xs={type:"childadded",child:null},$l={type:"childremoved",child:null},hn=class n extends Rn{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Xm++}),this.uuid=$s(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=n.DEFAULT_UP.clone();let e=new O,t=new Mi,i=new cn,s=new O(1,1,1);function r(){i.setFromEuler(t,!1)}function o(){t.setFromQuaternion(i,void 0,!1)}t._onChange(r),i._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:e},rotation:{configurable:!0,enumerable:!0,value:t},quaternion:{configurable:!0,enumerable:!0,value:i},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new ut},normalMatrix:{value:new Ue}}),this.matrix=new ut,this.matrixWorld=new ut,this.matrixAutoUpdate=n.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=n.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new vr,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return vs.setFromAxisAngle(e,t),this.quaternion.multiply(vs),this}rotateOnWorldAxis(e,t){return vs.setFromAxisAngle(e,t),this.quaternion.premultiply(vs),this}rotateX(e){return this.rotateOnAxis(Ku,e)}rotateY(e){return this.rotateOnAxis(Ju,e)}rotateZ(e){return this.rotateOnAxis(Qu,e)}translateOnAxis(e,t){return ju.copy(e).applyQuaternion(this.quaternion),this.position.add(ju.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(Ku,e)}translateY(e){return this.translateOnAxis(Ju,e)}translateZ(e){return this.translateOnAxis(Qu,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(Kn.copy(this.matrixWorld).invert())}lookAt(e,t,i){e.isVector3?_o.copy(e):_o.set(e,t,i);let s=this.parent;this.updateWorldMatrix(!0,!1),rr.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?Kn.lookAt(rr,_o,this.up):Kn.lookAt(_o,rr,this.up),this.quaternion.setFromRotationMatrix(Kn),s&&(Kn.extractRotation(s.matrixWorld),vs.setFromRotationMatrix(Kn),this.quaternion.premultiply(vs.invert()))}add(e){if(arguments.length>1){for(let t=0;t<arguments.length;t++)this.add(arguments[t]);return this}return e===this?(Oe("Object3D.add: object can't be added as a child of itself.",e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(ed),xs.child=e,this.dispatchEvent(xs),xs.child=null):Oe("Object3D.add: object not an instance of THREE.Object3D.",e),this)}remove(e){if(arguments.length>1){for(let i=0;i<arguments.length;i++)this.remove(arguments[i]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(jm),$l.child=e,this.dispatchEvent($l),$l.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),Kn.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),Kn.multiply(e.parent.matrixWorld)),e.applyMatrix4(Kn),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(ed),xs.child=e,this.dispatchEvent(xs),xs.child=null,this}getObjectById(e){return this.getObjectByProperty("id",e)}getObjectByName(e){return this.getObjectByProperty("name",e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let i=0,s=this.children.length;i<s;i++){let o=this.children[i].getObjectByProperty(e,t);if(o!==void 0)return o}}getObjectsByProperty(e,t,i=[]){this[e]===t&&i.push(this);let s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].getObjectsByProperty(e,t,i);return i}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(rr,e,Ym),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(rr,Zm,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let i=0,s=t.length;i<s;i++)t[i].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let i=0,s=t.length;i<s;i++)t[i].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,i=e.y,s=e.z,r=this.matrix.elements;r[12]+=t-r[0]*t-r[4]*i-r[8]*s,r[13]+=i-r[1]*t-r[5]*i-r[9]*s,r[14]+=s-r[2]*t-r[6]*i-r[10]*s}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let i=0,s=t.length;i<s;i++)t[i].updateMatrixWorld(e)}updateWorldMatrix(e,t,i=!1){let s=this.parent;if(e===!0&&s!==null&&s.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||i)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,i=!0),t===!0){let r=this.children;for(let o=0,a=r.length;o<a;o++)r[o].updateWorldMatrix(!1,!0,i)}}toJSON(e){let t=e===void 0||typeof e=="string",i={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},i.metadata={version:4.7,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,s.name=this.name,s.castShadow=this.castShadow,s.receiveShadow=this.receiveShadow,s.visible=this.visible,s.frustumCulled=this.frustumCulled,s.renderOrder=this.renderOrder,s.static=this.static,s.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.pivot!==null&&(s.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(s.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(s.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.geometryInfo=this._geometryInfo.map(a=>({...a,boundingBox:a.boundingBox?a.boundingBox.toJSON():void 0,boundingSphere:a.boundingSphere?a.boundingSphere.toJSON():void 0})),s.instanceInfo=this._instanceInfo.map(a=>({...a})),s.availableInstanceIds=this._availableInstanceIds.slice(),s.availableGeometryIds=this._availableGeometryIds.slice(),s.nextIndexStart=this._nextIndexStart,s.nextVertexStart=this._nextVertexStart,s.geometryCount=this._geometryCount,s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.matricesTexture=this._matricesTexture.toJSON(e),s.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(s.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(s.boundingBox=this.boundingBox.toJSON()));function r(a,l){return a[l.uuid]===void 0&&(a[l.uuid]=l.toJSON(e)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(e.geometries,this.geometry);let a=this.geometry.parameters;if(a!==void 0&&a.shapes!==void 0){let l=a.shapes;if(Array.isArray(l))for(let c=0,h=l.length;c<h;c++){let d=l[c];r(e.shapes,d)}else r(e.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(e.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let a=[];for(let l=0,c=this.material.length;l<c;l++)a.push(r(e.materials,this.material[l]));s.material=a}else s.material=r(e.materials,this.material);if(this.children.length>0){s.children=[];for(let a=0;a<this.children.length;a++)s.children.push(this.children[a].toJSON(e).object)}if(this.animations.length>0){s.animations=[];for(let a=0;a<this.animations.length;a++){let l=this.animations[a];s.animations.push(r(e.animations,l))}}if(t){let a=o(e.geometries),l=o(e.materials),c=o(e.textures),h=o(e.images),d=o(e.shapes),u=o(e.skeletons),f=o(e.animations),g=o(e.nodes);a.length>0&&(i.geometries=a),l.length>0&&(i.materials=l),c.length>0&&(i.textures=c),h.length>0&&(i.images=h),d.length>0&&(i.shapes=d),u.length>0&&(i.skeletons=u),f.length>0&&(i.animations=f),g.length>0&&(i.nodes=g)}return i.object=s,i;function o(a){let l=[];for(let c in a){let h=a[c];delete h.metadata,l.push(h)}return l}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot!==null?e.pivot.clone():null,this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let i=0;i<e.children.length;i++){let s=e.children[i];this.add(s.clone())}return this}dispose(){this.dispatchEvent({type:"dispose"})}};hn.DEFAULT_UP=new O(0,1,0);hn.DEFAULT_MATRIX_AUTO_UPDATE=!0;hn.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var Ji=class extends hn{constructor(){super(),this.isGroup=!0,this.type="Group"}},Km={type:"move"},Ns=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new Ji,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new Ji,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new O,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new O),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new Ji,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new O,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new O,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let i of e.hand.values())this._getHandJoint(t,i)}return this.dispatchEvent({type:"connected",data:e}),this}disconnect(e){return this.dispatchEvent({type:"disconnected",data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,i){let s=null,r=null,o=null,a=this._targetRay,l=this._grip,c=this._hand;if(e&&t.session.visibilityState!=="visible-blurred"){if(c&&e.hand){o=!0;for(let w of e.hand.values()){let p=t.getJointPose(w,i),m=this._getHandJoint(c,w);p!==null&&(m.matrix.fromArray(p.transform.matrix),m.matrix.decompose(m.position,m.quaternion,m.scale),m.matrixWorldNeedsUpdate=!0,m.jointRadius=p.radius),m.visible=p!==null}let h=c.joints["index-finger-tip"],d=c.joints["thumb-tip"],u=h.position.distanceTo(d.position),f=.02,g=.005;c.inputState.pinching&&u>f+g?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:e.handedness,target:this})):!c.inputState.pinching&&u<=f-g&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:e.handedness,target:this}))}else l!==null&&e.gripSpace&&(r=t.getPose(e.gripSpace,i),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.quaternion,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1,l.eventsEnabled&&l.dispatchEvent({type:"gripUpdated",data:e,target:this})));a!==null&&(s=t.getPose(e.targetRaySpace,i),s===null&&r!==null&&(s=r),s!==null&&(a.matrix.fromArray(s.transform.matrix),a.matrix.decompose(a.position,a.quaternion,a.scale),a.matrixWorldNeedsUpdate=!0,s.linearVelocity?(a.hasLinearVelocity=!0,a.linearVelocity.copy(s.linearVelocity)):a.hasLinearVelocity=!1,s.angularVelocity?(a.hasAngularVelocity=!0,a.angularVelocity.copy(s.angularVelocity)):a.hasAngularVelocity=!1,this.dispatchEvent(Km)))}return a!==null&&(a.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=o!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let i=new Ji;i.matrixAutoUpdate=!1,i.visible=!1,e.joints[t.jointName]=i,e.add(i)}return e.joints[t.jointName]}},Jd={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},xi={h:0,s:0,l:0},vo={h:0,s:0,l:0};function ql(n,e,t){return t<0&&(t+=1),t>1&&(t-=1),t<1/6?n+(e-n)*6*t:t<1/2?e:t<2/3?n+(e-n)*6*(2/3-t):n}var Ve=class{constructor(e,t,i){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,i)}set(e,t,i){if(t===void 0&&i===void 0){let s=e;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(e,t,i);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=an){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,Ke.colorSpaceToWorking(this,t),this}setRGB(e,t,i,s=Ke.workingColorSpace){return this.r=e,this.g=t,this.b=i,Ke.colorSpaceToWorking(this,s),this}setHSL(e,t,i,s=Ke.workingColorSpace){if(e=Bc(e,1),t=Xe(t,0,1),i=Xe(i,0,1),t===0)this.r=this.g=this.b=i;else{let r=i<=.5?i*(1+t):i+t-i*t,o=2*i-r;this.r=ql(o,r,e+1/3),this.g=ql(o,r,e),this.b=ql(o,r,e-1/3)}return Ke.colorSpaceToWorking(this,s),this}setStyle(e,t=an){function i(r){r!==void 0&&parseFloat(r)<1&&Le("Color: Alpha component of "+e+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(e)){let r,o=s[1],a=s[2];switch(o){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return i(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,t);if(r=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return i(r[4]),this.setRGB(Math.min(100,parseFloat(r[1]))/100,Math.min(100,parseFloat(r[2]))/100,Math.min(100,parseFloat(r[3]))/100,t);break;case"hsl":case"hsla":if(r=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(a))return i(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,t);break;default:Le("Color: Unknown color model "+e)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(e)){let r=s[1],o=r.length;if(o===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,t);if(o===6)return this.setHex(parseInt(r,16),t);Le("Color: Invalid hex color "+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=an){let i=Jd[e.toLowerCase()];return i!==void 0?this.setHex(i,t):Le("Color: Unknown color "+e),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=ni(e.r),this.g=ni(e.g),this.b=ni(e.b),this}copyLinearToSRGB(e){return this.r=Rs(e.r),this.g=Rs(e.g),this.b=Rs(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=an){return Ke.workingToColorSpace(Vt.copy(this),e),Math.round(Xe(Vt.r*255,0,255))*65536+Math.round(Xe(Vt.g*255,0,255))*256+Math.round(Xe(Vt.b*255,0,255))}getHexString(e=an){return("000000"+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=Ke.workingColorSpace){Ke.workingToColorSpace(Vt.copy(this),t);let i=Vt.r,s=Vt.g,r=Vt.b,o=Math.max(i,s,r),a=Math.min(i,s,r),l,c,h=(a+o)/2;if(a===o)l=0,c=0;else{let d=o-a;switch(c=h<=.5?d/(o+a):d/(2-o-a),o){case i:l=(s-r)/d+(s<r?6:0);break;case s:l=(r-i)/d+2;break;case r:l=(i-s)/d+4;break}l/=6}return e.h=l,e.s=c,e.l=h,e}getRGB(e,t=Ke.workingColorSpace){return Ke.workingToColorSpace(Vt.copy(this),t),e.r=Vt.r,e.g=Vt.g,e.b=Vt.b,e}getStyle(e=an){Ke.workingToColorSpace(Vt.copy(this),e);let t=Vt.r,i=Vt.g,s=Vt.b;return e!==an?`color(${e} ${t.toFixed(3)} ${i.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(t*255)},${Math.round(i*255)},${Math.round(s*255)})`}offsetHSL(e,t,i){return this.getHSL(xi),this.setHSL(xi.h+e,xi.s+t,xi.l+i)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,i){return this.r=e.r+(t.r-e.r)*i,this.g=e.g+(t.g-e.g)*i,this.b=e.b+(t.b-e.b)*i,this}lerpHSL(e,t){this.getHSL(xi),e.getHSL(vo);let i=ur(xi.h,vo.h,t),s=ur(xi.s,vo.s,t),r=ur(xi.l,vo.l,t);return this.setHSL(i,s,r),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,i=this.g,s=this.b,r=e.elements;return this.r=r[0]*t+r[3]*i+r[6]*s,this.g=r[1]*t+r[4]*i+r[7]*s,this.b=r[2]*t+r[5]*i+r[8]*s,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},Vt=new Ve;Ve.NAMES=Jd;var ks=class extends hn{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new Mi,this.environmentIntensity=1,this.environmentRotation=new Mi,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background!==null?e.background.clone():null,this.environment=e.environment!==null?e.environment.clone():null,this.fog=e.fog!==null?e.fog.clone():null,this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial!==null?e.overrideMaterial.clone():null,this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},En=new O,Jn=new O,Xl=new O,Qn=new O,ys=new O,bs=new O,td=new O,Yl=new O,Zl=new O,jl=new O,Kl=new vt,Jl=new vt,Ql=new vt,wi=class n{constructor(e=new O,t=new O,i=new O){this.a=e,this.b=t,this.c=i}static getNormal(e,t,i,s){s.subVectors(i,t),En.subVectors(e,t),s.cross(En);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(e,t,i,s,r){En.subVectors(s,t),Jn.subVectors(i,t),Xl.subVectors(e,t);let o=En.dot(En),a=En.dot(Jn),l=En.dot(Xl),c=Jn.dot(Jn),h=Jn.dot(Xl),d=o*c-a*a;if(d===0)return r.set(0,0,0),null;let u=1/d,f=(c*l-a*h)*u,g=(o*h-a*l)*u;return r.set(1-f-g,g,f)}static containsPoint(e,t,i,s){return this.getBarycoord(e,t,i,s,Qn)===null?!1:Qn.x>=0&&Qn.y>=0&&Qn.x+Qn.y<=1}static getInterpolation(e,t,i,s,r,o,a,l){return this.getBarycoord(e,t,i,s,Qn)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,Qn.x),l.addScaledVector(o,Qn.y),l.addScaledVector(a,Qn.z),l)}static getInterpolatedAttribute(e,t,i,s,r,o){return Kl.setScalar(0),Jl.setScalar(0),Ql.setScalar(0),Kl.fromBufferAttribute(e,t),Jl.fromBufferAttribute(e,i),Ql.fromBufferAttribute(e,s),o.setScalar(0),o.addScaledVector(Kl,r.x),o.addScaledVector(Jl,r.y),o.addScaledVector(Ql,r.z),o}static isFrontFacing(e,t,i,s){return En.subVectors(i,t),Jn.subVectors(e,t),En.cross(Jn).dot(s)<0}set(e,t,i){return this.a.copy(e),this.b.copy(t),this.c.copy(i),this}setFromPointsAndIndices(e,t,i,s){return this.a.copy(e[t]),this.b.copy(e[i]),this.c.copy(e[s]),this}setFromAttributeAndIndices(e,t,i,s){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,i),this.c.fromBufferAttribute(e,s),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return En.subVectors(this.c,this.b),Jn.subVectors(this.a,this.b),En.cross(Jn).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(e){return n.getNormal(this.a,this.b,this.c,e)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(e,t){return n.getBarycoord(e,this.a,this.b,this.c,t)}getInterpolation(e,t,i,s,r){return n.getInterpolation(e,this.a,this.b,this.c,t,i,s,r)}containsPoint(e){return n.containsPoint(e,this.a,this.b,this.c)}isFrontFacing(e){return n.isFrontFacing(this.a,this.b,this.c,e)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let i=this.a,s=this.b,r=this.c,o,a;ys.subVectors(s,i),bs.subVectors(r,i),Yl.subVectors(e,i);let l=ys.dot(Yl),c=bs.dot(Yl);if(l<=0&&c<=0)return t.copy(i);Zl.subVectors(e,s);let h=ys.dot(Zl),d=bs.dot(Zl);if(h>=0&&d<=h)return t.copy(s);let u=l*d-h*c;if(u<=0&&l>=0&&h<=0&&l-h>0)return o=l/(l-h),t.copy(i).addScaledVector(ys,o);jl.subVectors(e,r);let f=ys.dot(jl),g=bs.dot(jl);if(g>=0&&f<=g)return t.copy(r);let w=f*c-l*g;if(w<=0&&c>=0&&g<=0)return a=c/(c-g),t.copy(i).addScaledVector(bs,a);let p=h*g-f*d;if(p<=0&&d-h>=0&&f-g>=0)return td.subVectors(r,s),a=(d-h)/(d-h+(f-g)),t.copy(s).addScaledVector(td,a);let m=1/(p+w+u);return o=w*m,a=u*m,t.copy(i).addScaledVector(ys,o).addScaledVector(bs,a)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},Ai=class{constructor(e=new O(1/0,1/0,1/0),t=new O(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,i=e.length;t<i;t+=3)this.expandByPoint(Cn.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,i=e.count;t<i;t++)this.expandByPoint(Cn.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,i=e.length;t<i;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let i=Cn.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(i),this.max.copy(e).add(i),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let i=e.geometry;if(i!==void 0){let r=i.getAttribute("position");if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let o=0,a=r.count;o<a;o++)e.isMesh===!0?e.getVertexPosition(o,Cn):Cn.fromBufferAttribute(r,o),Cn.applyMatrix4(e.matrixWorld),this.expandByPoint(Cn);else e.boundingBox!==void 0?(e.boundingBox===null&&e.computeBoundingBox(),xo.copy(e.boundingBox)):(i.boundingBox===null&&i.computeBoundingBox(),xo.copy(i.boundingBox)),xo.applyMatrix4(e.matrixWorld),this.union(xo)}let s=e.children;for(let r=0,o=s.length;r<o;r++)this.expandByObject(s[r],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,Cn),Cn.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,i;return e.normal.x>0?(t=e.normal.x*this.min.x,i=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,i=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,i+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,i+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,i+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,i+=e.normal.z*this.min.z),t<=-e.constant&&i>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(or),yo.subVectors(this.max,or),Ss.subVectors(e.a,or),ws.subVectors(e.b,or),Ms.subVectors(e.c,or),yi.subVectors(ws,Ss),bi.subVectors(Ms,ws),Yi.subVectors(Ss,Ms);let t=[0,-yi.z,yi.y,0,-bi.z,bi.y,0,-Yi.z,Yi.y,yi.z,0,-yi.x,bi.z,0,-bi.x,Yi.z,0,-Yi.x,-yi.y,yi.x,0,-bi.y,bi.x,0,-Yi.y,Yi.x,0];return!ec(t,Ss,ws,Ms,yo)||(t=[1,0,0,0,1,0,0,0,1],!ec(t,Ss,ws,Ms,yo))?!1:(bo.crossVectors(yi,bi),t=[bo.x,bo.y,bo.z],ec(t,Ss,ws,Ms,yo))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,Cn).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(Cn).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()?this:(ei[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),ei[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),ei[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),ei[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),ei[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),ei[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),ei[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),ei[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(ei),this)}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},ei=[new O,new O,new O,new O,new O,new O,new O,new O],Cn=new O,xo=new Ai,Ss=new O,ws=new O,Ms=new O,yi=new O,bi=new O,Yi=new O,or=new O,yo=new O,bo=new O,Zi=new O;function ec(n,e,t,i,s){for(let r=0,o=n.length-3;r<=o;r+=3){Zi.fromArray(n,r);let a=s.x*Math.abs(Zi.x)+s.y*Math.abs(Zi.y)+s.z*Math.abs(Zi.z),l=e.dot(Zi),c=t.dot(Zi),h=i.dot(Zi);if(Math.max(-Math.max(l,c,h),Math.min(l,c,h))>a)return!1}return!0}var Mt=new O,So=new De,Jm=0,kt=class extends Rn{constructor(e,t,i=!1){if(super(),Array.isArray(e))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Jm++}),this.name="",this.array=e,this.itemSize=t,this.count=e!==void 0?e.length/t:0,this.normalized=i,this.usage=$d,this.updateRanges=[],this.gpuType=Ln,this.version=0,this._normalizationScale=e!==void 0?Gc(e):void 0}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,i){e*=this.itemSize,i*=t.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[e+s]=t.array[i+s];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,i=this.count;t<i;t++)So.fromBufferAttribute(this,t),So.applyMatrix3(e),this.setXY(t,So.x,So.y);else if(this.itemSize===3)for(let t=0,i=this.count;t<i;t++)Mt.fromBufferAttribute(this,t),Mt.applyMatrix3(e),this.setXYZ(t,Mt.x,Mt.y,Mt.z);return this}applyMatrix4(e){for(let t=0,i=this.count;t<i;t++)Mt.fromBufferAttribute(this,t),Mt.applyMatrix4(e),this.setXYZ(t,Mt.x,Mt.y,Mt.z);return this}applyNormalMatrix(e){for(let t=0,i=this.count;t<i;t++)Mt.fromBufferAttribute(this,t),Mt.applyNormalMatrix(e),this.setXYZ(t,Mt.x,Mt.y,Mt.z);return this}transformDirection(e){for(let t=0,i=this.count;t<i;t++)Mt.fromBufferAttribute(this,t),Mt.transformDirection(e),this.setXYZ(t,Mt.x,Mt.y,Mt.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let i=this.array[e*this.itemSize+t];return this.normalized&&(i=this._denormalize(i)),i}setComponent(e,t,i){return this.normalized&&(i=this._normalize(i)),this.array[e*this.itemSize+t]=i,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,i){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),i=this._normalize(i)),this.array[e+0]=t,this.array[e+1]=i,this}setXYZ(e,t,i,s){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),i=this._normalize(i),s=this._normalize(s)),this.array[e+0]=t,this.array[e+1]=i,this.array[e+2]=s,this}setXYZW(e,t,i,s,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),i=this._normalize(i),s=this._normalize(s),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=i,this.array[e+2]=s,this.array[e+3]=r,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:"dispose"})}_denormalize(e){let t=this._normalizationScale;return t!==void 0?Math.max(e/t,-1):jd(e,this.array)}_normalize(e){let t=this._normalizationScale;return t!==void 0?Math.round(e*t):Kd(e,this.array)}};var xr=class extends kt{constructor(e,t,i){super(new Uint16Array(e),t,i)}};var yr=class extends kt{constructor(e,t,i){super(new Uint32Array(e),t,i)}};var Sn=class extends kt{constructor(e,t,i){super(new Float32Array(e),t,i)}},Qm=new Ai,ar=new O,tc=new O,Bn=class{constructor(e=new O,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let i=this.center;t!==void 0?i.copy(t):Qm.setFromPoints(e).getCenter(i);let s=0;for(let r=0,o=e.length;r<o;r++)s=Math.max(s,i.distanceToSquared(e[r]));return this.radius=Math.sqrt(s),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let i=this.center.distanceToSquared(e);return t.copy(e),i>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius=this.radius*e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;ar.subVectors(e,this.center);let t=ar.lengthSq();if(t>this.radius*this.radius){let i=Math.sqrt(t),s=(i-this.radius)*.5;this.center.addScaledVector(ar,s/i),this.radius+=s}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(tc.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(ar.copy(e.center).add(tc)),this.expandByPoint(ar.copy(e.center).sub(tc))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},eg=0,yn=new ut,nc=new hn,As=new O,on=new Ai,lr=new Ai,Nt=new O,Gt=class n extends Rn{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:eg++}),this.uuid=$s(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return Array.isArray(e)?this.index=new(Am(e)?yr:xr)(e,1):this.index=e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,i=0){this.groups.push({start:e,count:t,materialIndex:i})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let i=this.attributes.normal;if(i!==void 0){let r=new Ue().getNormalMatrix(e);i.applyNormalMatrix(r),i.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(e),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return yn.makeRotationFromQuaternion(e),this.applyMatrix4(yn),this}rotateX(e){return yn.makeRotationX(e),this.applyMatrix4(yn),this}rotateY(e){return yn.makeRotationY(e),this.applyMatrix4(yn),this}rotateZ(e){return yn.makeRotationZ(e),this.applyMatrix4(yn),this}translate(e,t,i){return yn.makeTranslation(e,t,i),this.applyMatrix4(yn),this}scale(e,t,i){return yn.makeScale(e,t,i),this.applyMatrix4(yn),this}lookAt(e){return nc.lookAt(e),nc.updateMatrix(),this.applyMatrix4(nc.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(As).negate(),this.translate(As.x,As.y,As.z),this}setFromPoints(e){let t=this.getAttribute("position");if(t===void 0){let i=[];for(let s=0,r=e.length;s<r;s++){let o=e[s];i.push(o.x,o.y,o.z||0)}this.setAttribute("position",new Sn(i,3))}else{let i=Math.min(e.length,t.count);for(let s=0;s<i;s++){let r=e[s];t.setXYZ(s,r.x,r.y,r.z||0)}e.length>t.count&&Le("BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new Ai);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Oe("BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new O(-1/0,-1/0,-1/0),new O(1/0,1/0,1/0));return}if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let i=0,s=t.length;i<s;i++){let r=t[i];on.setFromBufferAttribute(r),this.morphTargetsRelative?(Nt.addVectors(this.boundingBox.min,on.min),this.boundingBox.expandByPoint(Nt),Nt.addVectors(this.boundingBox.max,on.max),this.boundingBox.expandByPoint(Nt)):(this.boundingBox.expandByPoint(on.min),this.boundingBox.expandByPoint(on.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&Oe('BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new Bn);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute){Oe("BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new O,1/0);return}if(e){let i=this.boundingSphere.center;if(on.setFromBufferAttribute(e),t)for(let r=0,o=t.length;r<o;r++){let a=t[r];lr.setFromBufferAttribute(a),this.morphTargetsRelative?(Nt.addVectors(on.min,lr.min),on.expandByPoint(Nt),Nt.addVectors(on.max,lr.max),on.expandByPoint(Nt)):(on.expandByPoint(lr.min),on.expandByPoint(lr.max))}on.getCenter(i);let s=0;for(let r=0,o=e.count;r<o;r++)Nt.fromBufferAttribute(e,r),s=Math.max(s,i.distanceToSquared(Nt));if(t)for(let r=0,o=t.length;r<o;r++){let a=t[r],l=this.morphTargetsRelative;for(let c=0,h=a.count;c<h;c++)Nt.fromBufferAttribute(a,c),l&&(As.fromBufferAttribute(e,c),Nt.add(As)),s=Math.max(s,i.distanceToSquared(Nt))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&Oe('BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){Oe("BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let i=t.position,s=t.normal,r=t.uv,o=this.getAttribute("tangent");(o===void 0||o.count!==i.count)&&(o=new kt(new Float32Array(4*i.count),4),this.setAttribute("tangent",o));let a=[],l=[],c=new Uint8Array(i.count);for(let F=0;F<i.count;F++)a[F]=new O,l[F]=new O;let h=new O,d=new O,u=new O,f=new De,g=new De,w=new De,p=new O,m=new O;function S(F,N,U){c[F]=c[N]=c[U]=1,h.fromBufferAttribute(i,F),d.fromBufferAttribute(i,N),u.fromBufferAttribute(i,U),f.fromBufferAttribute(r,F),g.fromBufferAttribute(r,N),w.fromBufferAttribute(r,U),d.sub(h),u.sub(h),g.sub(f),w.sub(f);let V=1/(g.x*w.y-w.x*g.y);isFinite(V)&&(p.copy(d).multiplyScalar(w.y).addScaledVector(u,-g.y).multiplyScalar(V),m.copy(u).multiplyScalar(g.x).addScaledVector(d,-w.x).multiplyScalar(V),a[F].add(p),a[N].add(p),a[U].add(p),l[F].add(m),l[N].add(m),l[U].add(m))}let R=this.groups;R.length===0&&(R=[{start:0,count:e.count}]);for(let F=0,N=R.length;F<N;++F){let U=R[F],V=U.start,q=U.count;for(let I=V,H=V+q;I<H;I+=3)S(e.getX(I+0),e.getX(I+1),e.getX(I+2))}let T=new O,M=new O,E=new O,_=new O;function A(F){E.fromBufferAttribute(s,F),_.copy(E);let N=a[F];T.copy(N),T.sub(E.multiplyScalar(E.dot(N))).normalize(),M.crossVectors(_,N);let V=M.dot(l[F])<0?-1:1;o.setXYZW(F,T.x,T.y,T.z,V)}for(let F=0,N=i.count;F<N;++F)c[F]&&A(F);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute("position");if(t!==void 0){let i=this.getAttribute("normal");if(i===void 0||i.count!==t.count)i=new kt(new Float32Array(t.count*3),3),this.setAttribute("normal",i);else for(let u=0,f=i.count;u<f;u++)i.setXYZ(u,0,0,0);let s=new O,r=new O,o=new O,a=new O,l=new O,c=new O,h=new O,d=new O;if(e)for(let u=0,f=e.count;u<f;u+=3){let g=e.getX(u+0),w=e.getX(u+1),p=e.getX(u+2);s.fromBufferAttribute(t,g),r.fromBufferAttribute(t,w),o.fromBufferAttribute(t,p),h.subVectors(o,r),d.subVectors(s,r),h.cross(d),a.fromBufferAttribute(i,g),l.fromBufferAttribute(i,w),c.fromBufferAttribute(i,p),a.add(h),l.add(h),c.add(h),i.setXYZ(g,a.x,a.y,a.z),i.setXYZ(w,l.x,l.y,l.z),i.setXYZ(p,c.x,c.y,c.z)}else for(let u=0,f=t.count;u<f;u+=3)s.fromBufferAttribute(t,u+0),r.fromBufferAttribute(t,u+1),o.fromBufferAttribute(t,u+2),h.subVectors(o,r),d.subVectors(s,r),h.cross(d),i.setXYZ(u+0,h.x,h.y,h.z),i.setXYZ(u+1,h.x,h.y,h.z),i.setXYZ(u+2,h.x,h.y,h.z);this.normalizeNormals(),i.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,i=e.count;t<i;t++)Nt.fromBufferAttribute(e,t),Nt.normalize(),e.setXYZ(t,Nt.x,Nt.y,Nt.z)}toNonIndexed(){function e(a,l){let c=a.array,h=a.itemSize,d=a.normalized,u=new c.constructor(l.length*h),f=0,g=0;for(let w=0,p=l.length;w<p;w++){a.isInterleavedBufferAttribute?f=l[w]*a.data.stride+a.offset:f=l[w]*h;for(let m=0;m<h;m++)u[g++]=c[f++]}return new kt(u,h,d)}if(this.index===null)return Le("BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let t=new n,i=this.index.array,s=this.attributes;for(let a in s){let l=s[a],c=e(l,i);t.setAttribute(a,c)}let r=this.morphAttributes;for(let a in r){let l=[],c=r[a];for(let h=0,d=c.length;h<d;h++){let u=c[h],f=e(u,i);l.push(f)}t.morphAttributes[a]=l}t.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let a=0,l=o.length;a<l;a++){let c=o[a];t.addGroup(c.start,c.count,c.materialIndex)}return t}toJSON(){let e={metadata:{version:4.7,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?"BufferGeometry":this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let l=this.parameters;for(let c in l)l[c]!==void 0&&(e[c]=l[c]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let i=this.attributes;for(let l in i){let c=i[l];e.data.attributes[l]=c.toJSON(e.data)}let s={},r=!1;for(let l in this.morphAttributes){let c=this.morphAttributes[l],h=[];for(let d=0,u=c.length;d<u;d++){let f=c[d];h.push(f.toJSON(e.data))}h.length>0&&(s[l]=h,r=!0)}r&&(e.data.morphAttributes=s,e.data.morphTargetsRelative=this.morphTargetsRelative);let o=this.groups;o.length>0&&(e.data.groups=JSON.parse(JSON.stringify(o)));let a=this.boundingSphere;return a!==null&&(e.data.boundingSphere=a.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let i=e.index;i!==null&&this.setIndex(i.clone());let s=e.attributes;for(let c in s){let h=s[c];this.setAttribute(c,h.clone(t))}let r=e.morphAttributes;for(let c in r){let h=[],d=r[c];for(let u=0,f=d.length;u<f;u++)h.push(d[u].clone(t));this.morphAttributes[c]=h}this.morphTargetsRelative=e.morphTargetsRelative;let o=e.groups;for(let c=0,h=o.length;c<h;c++){let d=o[c];this.addGroup(d.start,d.count,d.materialIndex)}let a=e.boundingBox;a!==null&&(this.boundingBox=a.clone());let l=e.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:"dispose"})}};var ic=new O,tg=new O,ng=new Ue,ln=class{constructor(e=new O(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,i,s){return this.normal.set(e,t,i),this.constant=s,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,i){let s=ic.subVectors(i,t).cross(tg.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(s,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,i=!0){let s=e.delta(ic),r=this.normal.dot(s);if(r===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let o=-(e.start.dot(this.normal)+this.constant)/r;return i===!0&&(o<0||o>1)?null:t.copy(e.start).addScaledVector(s,o)}intersectsLine(e){let t=this.distanceToPoint(e.start),i=this.distanceToPoint(e.end);return t<0&&i>0||i<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let i=t||ng.getNormalMatrix(e),s=this.coplanarPoint(ic).applyMatrix4(e),r=this.normal.applyMatrix3(i).normalize();return this.constant=-s.dot(r),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},ig=0,Ti=class extends Rn{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:ig++}),this.uuid=$s(),this.name="",this.type="Material",this.blending=Gs,this.side=Li,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=_c,this.blendDst=vc,this.blendEquation=ns,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new Ve(0,0,0),this.blendAlpha=0,this.depthFunc=Ps,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=zd,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=zo,this.stencilZFail=zo,this.stencilZPass=zo,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let i=e[t];if(i===void 0){Le(`Material: parameter '${t}' has value of undefined.`);continue}let s=this[t];if(s===void 0){Le(`Material: '${t}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(i):s&&s.isVector2&&i&&i.isVector2||s&&s.isEuler&&i&&i.isEuler||s&&s.isVector3&&i&&i.isVector3?s.copy(i):this[t]=i}}toJSON(e){let t=e===void 0||typeof e=="string";t&&(e={textures:{},images:{}});let i={metadata:{version:4.7,type:"Material",generator:"Material.toJSON"}};i.uuid=this.uuid,i.type=this.type,i.blending=this.blending,i.side=this.side,i.shadowSide=this.shadowSide,i.vertexColors=this.vertexColors,i.opacity=this.opacity,i.transparent=this.transparent,i.blendSrc=this.blendSrc,i.blendDst=this.blendDst,i.blendEquation=this.blendEquation,i.blendSrcAlpha=this.blendSrcAlpha,i.blendDstAlpha=this.blendDstAlpha,i.blendEquationAlpha=this.blendEquationAlpha,i.blendColor=this.blendColor.getHex(),i.blendAlpha=this.blendAlpha,i.depthFunc=this.depthFunc,i.depthTest=this.depthTest,i.depthWrite=this.depthWrite,i.colorWrite=this.colorWrite,i.clipIntersection=this.clipIntersection,i.clipShadows=this.clipShadows,i.stencilWriteMask=this.stencilWriteMask,i.stencilFunc=this.stencilFunc,i.stencilRef=this.stencilRef,i.stencilFuncMask=this.stencilFuncMask,i.stencilFail=this.stencilFail,i.stencilZFail=this.stencilZFail,i.stencilZPass=this.stencilZPass,i.stencilWrite=this.stencilWrite,i.polygonOffset=this.polygonOffset,i.polygonOffsetFactor=this.polygonOffsetFactor,i.polygonOffsetUnits=this.polygonOffsetUnits,i.dithering=this.dithering,i.alphaTest=this.alphaTest,i.alphaHash=this.alphaHash,i.alphaToCoverage=this.alphaToCoverage,i.premultipliedAlpha=this.premultipliedAlpha,i.forceSinglePass=this.forceSinglePass,i.allowOverride=this.allowOverride,i.visible=this.visible,i.toneMapped=this.toneMapped,i.name=this.name,this.color&&this.color.isColor&&(i.color=this.color.getHex()),this.roughness!==void 0&&(i.roughness=this.roughness),this.metalness!==void 0&&(i.metalness=this.metalness),this.sheen!==void 0&&(i.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(i.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(i.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(i.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(i.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(i.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(i.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(i.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(i.shininess=this.shininess),this.clearcoat!==void 0&&(i.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(i.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(i.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(i.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(i.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(i.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(i.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,i.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(i.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(i.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(i.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(i.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(i.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(i.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(i.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(i.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(i.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(i.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(i.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(i.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(i.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(i.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(i.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(i.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(i.lightMap=this.lightMap.toJSON(e).uuid,i.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(i.aoMap=this.aoMap.toJSON(e).uuid,i.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(i.bumpMap=this.bumpMap.toJSON(e).uuid,i.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(i.normalMap=this.normalMap.toJSON(e).uuid,i.normalMapType=this.normalMapType,i.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(i.displacementMap=this.displacementMap.toJSON(e).uuid,i.displacementScale=this.displacementScale,i.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(i.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(i.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(i.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(i.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(i.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(i.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(i.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(i.combine=this.combine)),this.envMapRotation!==void 0&&(i.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(i.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(i.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(i.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(i.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(i.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(i.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(i.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(i.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(i.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(i.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(i.size=this.size),this.sizeAttenuation!==void 0&&(i.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(i.clippingPlanes=this.clippingPlanes.map(r=>r.toJSON())),this.rotation!==void 0&&(i.rotation=this.rotation),this.depthPacking!==void 0&&(i.depthPacking=this.depthPacking),this.linewidth!==void 0&&(i.linewidth=this.linewidth),this.linecap!==void 0&&(i.linecap=this.linecap),this.linejoin!==void 0&&(i.linejoin=this.linejoin),this.dashSize!==void 0&&(i.dashSize=this.dashSize),this.gapSize!==void 0&&(i.gapSize=this.gapSize),this.scale!==void 0&&(i.scale=this.scale),this.wireframe!==void 0&&(i.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(i.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(i.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(i.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(i.flatShading=this.flatShading),this.fog!==void 0&&(i.fog=this.fog),Object.keys(this.userData).length>0&&(i.userData=this.userData);function s(r){let o=[];for(let a in r){let l=r[a];delete l.metadata,o.push(l)}return o}if(t){let r=s(e.textures),o=s(e.images);r.length>0&&(i.textures=r),o.length>0&&(i.images=o)}return i}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new Ve().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(i=>new ln().fromJSON(i))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(typeof e.vertexColors=="number"?this.vertexColors=e.vertexColors>0:this.vertexColors=e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let i=e.normalScale;Array.isArray(i)===!1&&(i=[i,i]),this.normalScale=new De().fromArray(i)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new De().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,i=null;if(t!==null){let s=t.length;i=new Array(s);for(let r=0;r!==s;++r)i[r]=t[r].clone()}return this.clippingPlanes=i,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(e){e===!0&&this.version++}};var ti=new O,sc=new O,wo=new O,Mo=new O,Qi=class{constructor(e=new O,t=new O(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,ti)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let i=t.dot(this.direction);return i<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,i)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=ti.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(ti.copy(this.origin).addScaledVector(this.direction,t),ti.distanceToSquared(e))}distanceSqToSegment(e,t,i,s){sc.copy(e).add(t).multiplyScalar(.5),wo.copy(t).sub(e).normalize(),Mo.copy(this.origin).sub(sc);let r=e.distanceTo(t)*.5,o=-this.direction.dot(wo),a=Mo.dot(this.direction),l=-Mo.dot(wo),c=Mo.lengthSq(),h=Math.abs(1-o*o),d,u,f,g;if(h>0)if(d=o*l-a,u=o*a-l,g=r*h,d>=0)if(u>=-g)if(u<=g){let w=1/h;d*=w,u*=w,f=d*(d+o*u+2*a)+u*(o*d+u+2*l)+c}else u=r,d=Math.max(0,-(o*u+a)),f=-d*d+u*(u+2*l)+c;else u=-r,d=Math.max(0,-(o*u+a)),f=-d*d+u*(u+2*l)+c;else u<=-g?(d=Math.max(0,-(-o*r+a)),u=d>0?-r:Math.min(Math.max(-r,-l),r),f=-d*d+u*(u+2*l)+c):u<=g?(d=0,u=Math.min(Math.max(-r,-l),r),f=u*(u+2*l)+c):(d=Math.max(0,-(o*r+a)),u=d>0?r:Math.min(Math.max(-r,-l),r),f=-d*d+u*(u+2*l)+c);else u=o>0?-r:r,d=Math.max(0,-(o*u+a)),f=-d*d+u*(u+2*l)+c;return i&&i.copy(this.origin).addScaledVector(this.direction,d),s&&s.copy(sc).addScaledVector(wo,u),f}intersectSphere(e,t){if(e.radius<0)return null;ti.subVectors(e.center,this.origin);let i=ti.dot(this.direction),s=ti.dot(ti)-i*i,r=e.radius*e.radius;if(s>r)return null;let o=Math.sqrt(r-s),a=i-o,l=i+o;return l<0?null:a<0?this.at(l,t):this.at(a,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let i=-(this.origin.dot(e.normal)+e.constant)/t;return i>=0?i:null}intersectPlane(e,t){let i=this.distanceToPlane(e);return i===null?null:this.at(i,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let i,s,r,o,a,l,c=1/this.direction.x,h=1/this.direction.y,d=1/this.direction.z,u=this.origin;return c>=0?(i=(e.min.x-u.x)*c,s=(e.max.x-u.x)*c):(i=(e.max.x-u.x)*c,s=(e.min.x-u.x)*c),h>=0?(r=(e.min.y-u.y)*h,o=(e.max.y-u.y)*h):(r=(e.max.y-u.y)*h,o=(e.min.y-u.y)*h),i>o||r>s||((r>i||isNaN(i))&&(i=r),(o<s||isNaN(s))&&(s=o),d>=0?(a=(e.min.z-u.z)*d,l=(e.max.z-u.z)*d):(a=(e.max.z-u.z)*d,l=(e.min.z-u.z)*d),i>l||a>s)||((a>i||i!==i)&&(i=a),(l<s||s!==s)&&(s=l),s<0)?null:this.at(i>=0?i:s,t)}intersectsBox(e){return this.intersectBox(e,ti)!==null}intersectTriangle(e,t,i,s,r){let o=this.origin,a=this.direction,l=a.x,c=a.y,h=a.z,d=e.x-o.x,u=e.y-o.y,f=e.z-o.z,g=t.x-o.x,w=t.y-o.y,p=t.z-o.z,m=i.x-o.x,S=i.y-o.y,R=i.z-o.z,T=Math.abs(l),M=Math.abs(c),E=Math.abs(h),_,A,F,N,U,V,q,I,H,Z,W,ie;if(T>=M&&T>=E?(F=l,V=d,H=g,ie=m,l>=0?(_=c,A=h,N=u,U=f,q=w,I=p,Z=S,W=R):(_=h,A=c,N=f,U=u,q=p,I=w,Z=R,W=S)):M>=E?(F=c,V=u,H=w,ie=S,c>=0?(_=h,A=l,N=f,U=d,q=p,I=g,Z=R,W=m):(_=l,A=h,N=d,U=f,q=g,I=p,Z=m,W=R)):(F=h,V=f,H=p,ie=R,h>=0?(_=l,A=c,N=d,U=u,q=g,I=w,Z=m,W=S):(_=c,A=l,N=u,U=d,q=w,I=g,Z=S,W=m)),F===0)return null;let Y=_/F,te=A/F,ne=1/F,Ae=N-Y*V,ze=U-te*V,J=q-Y*H,_e=I-te*H,Se=Z-Y*ie,Re=W-te*ie,ve=Se*_e-Re*J,Ge=Ae*Re-ze*Se,bt=J*ze-_e*Ae;if(s){if(ve<0||Ge<0||bt<0)return null}else if((ve<0||Ge<0||bt<0)&&(ve>0||Ge>0||bt>0))return null;let Ne=ve+Ge+bt;if(Ne===0)return null;let rt=ne*(ve*V+Ge*H+bt*ie);return(Ne>0?rt<0:rt>0)?null:this.at(rt/Ne,r)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},Qo=class extends Ti{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type="MeshBasicMaterial",this.color=new Ve(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Mi,this.combine=xc,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},nd=new ut,ji=new Qi,Ao=new Bn,id=new O,To=new O,Eo=new O,Co=new O,rc=new O,Ro=new O,sd=new O,Po=new O,Zt=class extends hn{constructor(e=new Gt,t=new Qo){super(),this.isMesh=!0,this.type="Mesh",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let t=this.geometry.morphAttributes,i=Object.keys(t);if(i.length>0){let s=t[i[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}getVertexPosition(e,t){let i=this.geometry,s=i.attributes.position,r=i.morphAttributes.position,o=i.morphTargetsRelative;t.fromBufferAttribute(s,e);let a=this.morphTargetInfluences;if(r&&a){Ro.set(0,0,0);for(let l=0,c=r.length;l<c;l++){let h=a[l],d=r[l];h!==0&&(rc.fromBufferAttribute(d,e),o?Ro.addScaledVector(rc,h):Ro.addScaledVector(rc.sub(t),h))}t.add(Ro)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let i=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(i.boundingSphere===null&&i.computeBoundingSphere(),Ao.copy(i.boundingSphere),Ao.applyMatrix4(r),ji.copy(e.ray).recast(e.near),!(Ao.containsPoint(ji.origin)===!1&&(ji.intersectSphere(Ao,id)===null||ji.origin.distanceToSquared(id)>(e.far-e.near)**2))&&(nd.copy(r).invert(),ji.copy(e.ray).applyMatrix4(nd),!(i.boundingBox!==null&&ji.intersectsBox(i.boundingBox)===!1)&&this._computeIntersections(e,t,ji)))}_computeIntersections(e,t,i){let s,r=this.geometry,o=this.material,a=r.index,l=r.attributes.position,c=r.attributes.uv,h=r.attributes.uv1,d=r.attributes.normal,u=r.groups,f=r.drawRange;if(a!==null)if(Array.isArray(o))for(let g=0,w=u.length;g<w;g++){let p=u[g],m=o[p.materialIndex],S=Math.max(p.start,f.start),R=Math.min(a.count,Math.min(p.start+p.count,f.start+f.count));for(let T=S,M=R;T<M;T+=3){let E=a.getX(T),_=a.getX(T+1),A=a.getX(T+2);s=Io(this,m,e,i,c,h,d,E,_,A),s&&(s.faceIndex=Math.floor(T/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let g=Math.max(0,f.start),w=Math.min(a.count,f.start+f.count);for(let p=g,m=w;p<m;p+=3){let S=a.getX(p),R=a.getX(p+1),T=a.getX(p+2);s=Io(this,o,e,i,c,h,d,S,R,T),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}else if(l!==void 0)if(Array.isArray(o))for(let g=0,w=u.length;g<w;g++){let p=u[g],m=o[p.materialIndex],S=Math.max(p.start,f.start),R=Math.min(l.count,Math.min(p.start+p.count,f.start+f.count));for(let T=S,M=R;T<M;T+=3){let E=T,_=T+1,A=T+2;s=Io(this,m,e,i,c,h,d,E,_,A),s&&(s.faceIndex=Math.floor(T/3),s.face.materialIndex=p.materialIndex,t.push(s))}}else{let g=Math.max(0,f.start),w=Math.min(l.count,f.start+f.count);for(let p=g,m=w;p<m;p+=3){let S=p,R=p+1,T=p+2;s=Io(this,o,e,i,c,h,d,S,R,T),s&&(s.faceIndex=Math.floor(p/3),t.push(s))}}}};function sg(n,e,t,i,s,r,o,a){let l;if(e.side===jt?l=i.intersectTriangle(o,r,s,!0,a):l=i.intersectTriangle(s,r,o,e.side===Li,a),l===null)return null;Po.copy(a),Po.applyMatrix4(n.matrixWorld);let c=t.ray.origin.distanceTo(Po);return c<t.near||c>t.far?null:{distance:c,point:Po.clone(),object:n}}function Io(n,e,t,i,s,r,o,a,l,c){n.getVertexPosition(a,To),n.getVertexPosition(l,Eo),n.getVertexPosition(c,Co);let h=sg(n,e,t,i,To,Eo,Co,sd);if(h){let d=new O;wi.getBarycoord(sd,To,Eo,Co,d),s&&(h.uv=wi.getInterpolatedAttribute(s,a,l,c,d,new De)),r&&(h.uv1=wi.getInterpolatedAttribute(r,a,l,c,d,new De)),o&&(h.normal=wi.getInterpolatedAttribute(o,a,l,c,d,new O),h.normal.dot(i.direction)>0&&h.normal.multiplyScalar(-1));let u={a,b:l,c,normal:new O,materialIndex:0};wi.getNormal(To,Eo,Co,u.normal),h.face=u,h.barycoord=d}return h}var es=class extends en{constructor(e=null,t=1,i=1,s,r,o,a,l,c=yt,h=yt,d,u){super(null,o,a,l,c,h,s,r,d,u),this.isDataTexture=!0,this.image={data:e,width:t,height:i},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var Ki=new Bn,rg=new De(.5,.5),Lo=new O,si=class{constructor(e=new ln,t=new ln,i=new ln,s=new ln,r=new ln,o=new ln){this.planes=[e,t,i,s,r,o]}set(e,t,i,s,r,o){let a=this.planes;return a[0].copy(e),a[1].copy(t),a[2].copy(i),a[3].copy(s),a[4].copy(r),a[5].copy(o),this}copy(e){let t=this.planes;for(let i=0;i<6;i++)t[i].copy(e.planes[i]);return this}setFromProjectionMatrix(e,t=bn,i=!1){let s=this.planes,r=e.elements,o=r[0],a=r[1],l=r[2],c=r[3],h=r[4],d=r[5],u=r[6],f=r[7],g=r[8],w=r[9],p=r[10],m=r[11],S=r[12],R=r[13],T=r[14],M=r[15];if(s[0].setComponents(c-o,f-h,m-g,M-S).normalize(),s[1].setComponents(c+o,f+h,m+g,M+S).normalize(),s[2].setComponents(c+a,f+d,m+w,M+R).normalize(),s[3].setComponents(c-a,f-d,m-w,M-R).normalize(),i)s[4].setComponents(l,u,p,T).normalize(),s[5].setComponents(c-l,f-u,m-p,M-T).normalize();else if(s[4].setComponents(c-l,f-u,m-p,M-T).normalize(),t===bn)s[5].setComponents(c+l,f+u,m+p,M+T).normalize();else if(t===mr)s[5].setComponents(l,u,p,T).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Ki.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Ki.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Ki)}intersectsSprite(e){Ki.center.set(0,0,0);let t=rg.distanceTo(e.center);return Ki.radius=.7071067811865476+t,Ki.applyMatrix4(e.matrixWorld),this.intersectsSphere(Ki)}intersectsSphere(e){let t=this.planes,i=e.center,s=-e.radius;for(let r=0;r<6;r++)if(t[r].distanceToPoint(i)<s)return!1;return!0}intersectsBox(e){let t=this.planes;for(let i=0;i<6;i++){let s=t[i];if(Lo.x=s.normal.x>0?e.max.x:e.min.x,Lo.y=s.normal.y>0?e.max.y:e.min.y,Lo.z=s.normal.z>0?e.max.z:e.min.z,s.distanceToPoint(Lo)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let i=0;i<6;i++)if(t[i].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},rd=new ut,ea=class n{constructor(){this.coordinateSystem=bn,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,i=this._frustums;for(let s=0;s<t.length;s++){let r=t[s];rd.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),i[s]===void 0&&(i[s]=new si),i[s].setFromProjectionMatrix(rd,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let i=0;i<this._count;i++)if(t[i].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,i=e._frustums;for(let s=0;s<e._count;s++)t[s]===void 0&&(t[s]=new si),t[s].copy(i[s]);return this._count=e._count,this}clone(){return new n().copy(this)}};var ta=class extends Ti{constructor(e){super(),this.isPointsMaterial=!0,this.type="PointsMaterial",this.color=new Ve(16777215),this.map=null,this.alphaMap=null,this.size=1,this.sizeAttenuation=!0,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.alphaMap=e.alphaMap,this.size=e.size,this.sizeAttenuation=e.sizeAttenuation,this.fog=e.fog,this}},od=new ut,hc=new Qi,Do=new Bn,No=new O,Os=class extends hn{constructor(e=new Gt,t=new ta){super(),this.isPoints=!0,this.type="Points",this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),e.morphTargetInfluences!==void 0?this.morphTargetInfluences=e.morphTargetInfluences.slice():this.morphTargetInfluences=void 0,e.morphTargetDictionary!==void 0?this.morphTargetDictionary=Object.assign({},e.morphTargetDictionary):this.morphTargetDictionary=void 0,this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let i=this.geometry,s=this.matrixWorld,r=e.params.Points.threshold,o=i.drawRange;if(i.boundingSphere===null&&i.computeBoundingSphere(),Do.copy(i.boundingSphere),Do.applyMatrix4(s),Do.radius+=r,e.ray.intersectsSphere(Do)===!1)return;od.copy(s).invert(),hc.copy(e.ray).applyMatrix4(od);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=i.index,d=i.attributes.position;if(c!==null){let u=Math.max(0,o.start),f=Math.min(c.count,o.start+o.count);for(let g=u,w=f;g<w;g++){let p=c.getX(g);No.fromBufferAttribute(d,p),ad(No,p,l,s,e,t,this)}}else{let u=Math.max(0,o.start),f=Math.min(d.count,o.start+o.count);for(let g=u,w=f;g<w;g++)No.fromBufferAttribute(d,g),ad(No,g,l,s,e,t,this)}}updateMorphTargets(){let t=this.geometry.morphAttributes,i=Object.keys(t);if(i.length>0){let s=t[i[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function ad(n,e,t,i,s,r,o){let a=hc.distanceSqToPoint(n);if(a<t){let l=new O;hc.closestPointToPoint(n,l),l.applyMatrix4(i);let c=s.ray.origin.distanceTo(l);if(c<s.near||c>s.far)return;r.push({distance:c,distanceToRay:Math.sqrt(a),point:l,index:e,face:null,faceIndex:null,barycoord:null,object:o})}}var br=class extends en{constructor(e=[],t=is,i,s,r,o,a,l,c,h){super(e,t,i,s,r,o,a,l,c,h),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}};var ri=class extends en{constructor(e,t,i=In,s,r,o,a=yt,l=yt,c,h=ii,d=1){if(h!==ii&&h!==ai)throw new Error("THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat");let u={width:e,height:t,depth:d};super(u,s,r,o,a,l,h,i,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new Ds(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},Sr=class extends ri{constructor(e,t=In,i=is,s,r,o=yt,a=yt,l,c=ii){let h={width:e,height:e,depth:1},d=[h,h,h,h,h,h];super(e,e,t,i,s,r,o,a,l,c),this.image=d,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},wr=class extends en{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},Us=class n extends Gt{constructor(e=1,t=1,i=1,s=1,r=1,o=1){super(),this.type="BoxGeometry",this.parameters={width:e,height:t,depth:i,widthSegments:s,heightSegments:r,depthSegments:o};let a=this;s=Math.floor(s),r=Math.floor(r),o=Math.floor(o);let l=[],c=[],h=[],d=[],u=0,f=0;g("z","y","x",-1,-1,i,t,e,o,r,0),g("z","y","x",1,-1,i,t,-e,o,r,1),g("x","z","y",1,1,e,i,t,s,o,2),g("x","z","y",1,-1,e,i,-t,s,o,3),g("x","y","z",1,-1,e,t,i,s,r,4),g("x","y","z",-1,-1,e,t,-i,s,r,5),this.setIndex(l),this.setAttribute("position",new Sn(c,3)),this.setAttribute("normal",new Sn(h,3)),this.setAttribute("uv",new Sn(d,2));function g(w,p,m,S,R,T,M,E,_,A,F){let N=T/_,U=M/A,V=T/2,q=M/2,I=E/2,H=_+1,Z=A+1,W=0,ie=0,Y=new O;for(let te=0;te<Z;te++){let ne=te*U-q;for(let Ae=0;Ae<H;Ae++){let ze=Ae*N-V;Y[w]=ze*S,Y[p]=ne*R,Y[m]=I,c.push(Y.x,Y.y,Y.z),Y[w]=0,Y[p]=0,Y[m]=E>0?1:-1,h.push(Y.x,Y.y,Y.z),d.push(Ae/_),d.push(1-te/A),W+=1}}for(let te=0;te<A;te++)for(let ne=0;ne<_;ne++){let Ae=u+ne+H*te,ze=u+ne+H*(te+1),J=u+(ne+1)+H*(te+1),_e=u+(ne+1)+H*te;l.push(Ae,ze,_e),l.push(ze,J,_e),ie+=6}a.addGroup(f,ie,F),f+=ie,u+=W}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new n(e.width,e.height,e.depth,e.widthSegments,e.heightSegments,e.depthSegments)}};var Mr=class n extends Gt{constructor(e=1,t=1,i=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:e,height:t,widthSegments:i,heightSegments:s};let r=e/2,o=t/2,a=Math.floor(i),l=Math.floor(s),c=a+1,h=l+1,d=e/a,u=t/l,f=[],g=[],w=[],p=[];for(let m=0;m<h;m++){let S=m*u-o;for(let R=0;R<c;R++){let T=R*d-r;g.push(T,-S,0),w.push(0,0,1),p.push(R/a),p.push(1-m/l)}}for(let m=0;m<l;m++)for(let S=0;S<a;S++){let R=S+c*m,T=S+c*(m+1),M=S+1+c*(m+1),E=S+1+c*m;f.push(R,T,E),f.push(T,M,E)}this.setIndex(f),this.setAttribute("position",new Sn(g,3)),this.setAttribute("normal",new Sn(w,3)),this.setAttribute("uv",new Sn(p,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(e){return new n(e.width,e.height,e.widthSegments,e.heightSegments)}};function rs(n){let e={};for(let t in n){e[t]={};for(let i in n[t]){let s=n[t][i];if(ld(s))s.isRenderTargetTexture?(Le("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),e[t][i]=null):e[t][i]=s.clone();else if(Array.isArray(s))if(ld(s[0])){let r=[];for(let o=0,a=s.length;o<a;o++)r[o]=s[o].clone();e[t][i]=r}else e[t][i]=s.slice();else e[t][i]=s}}return e}function Wt(n){let e={};for(let t=0;t<n.length;t++){let i=rs(n[t]);for(let s in i)e[s]=i[s]}return e}function ld(n){return n&&(n.isColor||n.isMatrix3||n.isMatrix4||n.isVector2||n.isVector3||n.isVector4||n.isTexture||n.isQuaternion)}function og(n){let e=[];for(let t=0;t<n.length;t++)e.push(n[t].clone());return e}function Wc(n){let e=n.getRenderTarget();return e===null?n.outputColorSpace:e.isXRRenderTarget===!0?e.texture.colorSpace:Ke.workingColorSpace}var Qd={clone:rs,merge:Wt},ag=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,lg=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,Vn=class extends Ti{constructor(e){super(),this.isShaderMaterial=!0,this.type="ShaderMaterial",this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=ag,this.fragmentShader=lg,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=rs(e.uniforms),this.uniformsGroups=og(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let s in this.uniforms){let o=this.uniforms[s].value;o&&o.isTexture?t.uniforms[s]={type:"t",value:o.toJSON(e).uuid}:o&&o.isColor?t.uniforms[s]={type:"c",value:o.getHex()}:o&&o.isVector2?t.uniforms[s]={type:"v2",value:o.toArray()}:o&&o.isVector3?t.uniforms[s]={type:"v3",value:o.toArray()}:o&&o.isVector4?t.uniforms[s]={type:"v4",value:o.toArray()}:o&&o.isMatrix3?t.uniforms[s]={type:"m3",value:o.toArray()}:o&&o.isMatrix4?t.uniforms[s]={type:"m4",value:o.toArray()}:t.uniforms[s]={value:o}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let i={};for(let s in this.extensions)this.extensions[s]===!0&&(i[s]=!0);return Object.keys(i).length>0&&(t.extensions=i),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let i in e.uniforms){let s=e.uniforms[i];switch(this.uniforms[i]={},s.type){case"t":this.uniforms[i].value=t[s.value]||null;break;case"c":this.uniforms[i].value=new Ve().setHex(s.value);break;case"v2":this.uniforms[i].value=new De().fromArray(s.value);break;case"v3":this.uniforms[i].value=new O().fromArray(s.value);break;case"v4":this.uniforms[i].value=new vt().fromArray(s.value);break;case"m3":this.uniforms[i].value=new Ue().fromArray(s.value);break;case"m4":this.uniforms[i].value=new ut().fromArray(s.value);break;default:this.uniforms[i].value=s.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let i in e.extensions)this.extensions[i]=e.extensions[i];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},Pn=class extends Vn{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type="RawShaderMaterial"}};var na=class extends Ti{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type="MeshDepthMaterial",this.depthPacking=Ud,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},ia=class extends Ti{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type="MeshDistanceMaterial",this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}};function Ts(n,e){return!n||n.constructor===e?n:typeof e.BYTES_PER_ELEMENT=="number"?new e(n):Array.prototype.slice.call(n)}function ko(n){return n!==void 0&&n.inTangents!==void 0&&n.outTangents!==void 0}var Ei=class{constructor(e,t,i,s){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new t.constructor(i),this.sampleValues=t,this.valueSize=i,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,i=this._cachedIndex,s=t[i],r=t[i-1];n:{e:{let o;t:{i:if(!(e<s)){for(let a=i+2;;){if(s===void 0){if(e<r)break i;return i=t.length,this._cachedIndex=i,this.copySampleValue_(i-1)}if(i===a)break;if(r=s,s=t[++i],e<s)break e}o=t.length;break t}if(!(e>=r)){let a=t[1];e<a&&(i=2,r=a);for(let l=i-2;;){if(r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(i===l)break;if(s=r,r=t[--i-1],e>=r)break e}o=i,i=0;break t}break n}for(;i<o;){let a=i+o>>>1;e<t[a]?o=a:i=a+1}if(s=t[i],r=t[i-1],r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return i=t.length,this._cachedIndex=i,this.copySampleValue_(i-1)}this._cachedIndex=i,this.intervalChanged_(i,r,s)}return this.interpolate_(i,r,e,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,i=this.sampleValues,s=this.valueSize,r=e*s;for(let o=0;o!==s;++o)t[o]=i[r+o];return t}interpolate_(){throw new Error("THREE.Interpolant: Call to abstract method.")}intervalChanged_(){}},sa=class extends Ei{constructor(e,t,i,s){super(e,t,i,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:ac,endingEnd:ac}}intervalChanged_(e,t,i){let s=this.parameterPositions,r=e-2,o=e+1,a=s[r],l=s[o];if(a===void 0)switch(this.getSettings_().endingStart){case lc:r=e,a=2*t-i;break;case cc:r=s.length-2,a=t+s[r]-s[r+1];break;default:r=e,a=i}if(l===void 0)switch(this.getSettings_().endingEnd){case lc:o=e,l=2*i-t;break;case cc:o=1,l=i+s[1]-s[0];break;default:o=e-1,l=t}let c=(i-t)*.5,h=this.valueSize;this._weightPrev=c/(t-a),this._weightNext=c/(l-i),this._offsetPrev=r*h,this._offsetNext=o*h}interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,h=this._offsetPrev,d=this._offsetNext,u=this._weightPrev,f=this._weightNext,g=(i-t)/(s-t),w=g*g,p=w*g,m=-u*p+2*u*w-u*g,S=(1+u)*p+(-1.5-2*u)*w+(-.5+u)*g+1,R=(-1-f)*p+(1.5+f)*w+.5*g,T=f*p-f*w;for(let M=0;M!==a;++M)r[M]=m*o[h+M]+S*o[c+M]+R*o[l+M]+T*o[d+M];return r}},ra=class extends Ei{constructor(e,t,i,s){super(e,t,i,s)}interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,h=(i-t)/(s-t),d=1-h;for(let u=0;u!==a;++u)r[u]=o[c+u]*d+o[l+u]*h;return r}},oa=class extends Ei{constructor(e,t,i,s){super(e,t,i,s)}interpolate_(e){return this.copySampleValue_(e-1)}},aa=class extends Ei{interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=e*a,c=l-a,h=this.inTangents,d=this.outTangents;if(!h||!d){let g=(i-t)/(s-t),w=1-g;for(let p=0;p!==a;++p)r[p]=o[c+p]*w+o[l+p]*g;return r}let u=a*2,f=e-1;for(let g=0;g!==a;++g){let w=o[c+g],p=o[l+g],m=f*u+g*2,S=d[m],R=d[m+1],T=e*u+g*2,M=h[T],E=h[T+1],_=hg(i,t,S,M,s);r[g]=ef(_,w,R,E,p)}return r}};function ef(n,e,t,i,s){let r=1-n;return r*r*r*e+3*r*r*n*t+3*r*n*n*i+n*n*n*s}function cg(n,e,t,i,s){let r=1-n;return 3*r*r*(t-e)+6*r*n*(i-t)+3*n*n*(s-i)}function hg(n,e,t,i,s){let r=(n-e)/(s-e);for(let o=0;o<8;o++){let a=ef(r,e,t,i,s)-n;if(Math.abs(a)<1e-10)break;let l=cg(r,e,t,i,s);if(Math.abs(l)<1e-10)break;r=Math.max(0,Math.min(1,r-a/l))}return r}var un=class{constructor(e,t,i,s){if(e===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(t===void 0||t.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+e);this.name=e,this.times=Ts(t,this.TimeBufferType),this.values=Ts(i,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,i;if(t.toJSON!==this.toJSON)i=t.toJSON(e);else{i={name:e.name,times:Ts(e.times,Array),values:Ts(e.values,Array)};let s=e.getInterpolation();s!==e.DefaultInterpolation&&(i.interpolation=s),ko(e.settings)&&(i.settings={inTangents:Ts(e.settings.inTangents,Array),outTangents:Ts(e.settings.outTangents,Array)})}return i.type=e.ValueTypeName,i}InterpolantFactoryMethodDiscrete(e){return new oa(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new ra(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new sa(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new aa(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case dr:t=this.InterpolantFactoryMethodDiscrete;break;case Zo:t=this.InterpolantFactoryMethodLinear;break;case Fo:t=this.InterpolantFactoryMethodSmooth;break;case oc:t=this.InterpolantFactoryMethodBezier;break}if(t===void 0){let i="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(i);return Le("KeyframeTrack:",i),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return dr;case this.InterpolantFactoryMethodLinear:return Zo;case this.InterpolantFactoryMethodSmooth:return Fo;case this.InterpolantFactoryMethodBezier:return oc}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let i=0,s=t.length;i!==s;++i)t[i]+=e;ko(this.settings)&&(cd(this.settings.inTangents,e),cd(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let i=0,s=t.length;i!==s;++i)t[i]*=e;ko(this.settings)&&(hd(this.settings.inTangents,e),hd(this.settings.outTangents,e))}return this}trim(e,t){let i=this.times,s=i.length,r=0,o=s-1;for(;r!==s&&i[r]<e;)++r;for(;o!==-1&&i[o]>t;)--o;if(++o,r!==0||o!==s){r>=o&&(o=Math.max(o,1),r=o-1);let a=this.getValueSize();this.times=i.slice(r,o),this.values=this.values.slice(r*a,o*a)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(Oe("KeyframeTrack: Invalid value size in track.",this),e=!1);let i=this.times,s=this.values,r=i.length;r===0&&(Oe("KeyframeTrack: Track is empty.",this),e=!1);let o=null;for(let a=0;a!==r;a++){let l=i[a];if(typeof l=="number"&&isNaN(l)){Oe("KeyframeTrack: Time is not a valid number.",this,a,l),e=!1;break}if(o!==null&&o>l){Oe("KeyframeTrack: Out of order keys.",this,a,l,o),e=!1;break}o=l}if(s!==void 0&&Tm(s))for(let a=0,l=s.length;a!==l;++a){let c=s[a];if(isNaN(c)){Oe("KeyframeTrack: Value is not a valid number.",this,a,c),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),i=this.getValueSize(),s=this.getInterpolation()===Fo,r=e.length-1,o=1;for(let a=1;a<r;++a){let l=!1,c=e[a],h=e[a+1];if(c!==h&&(a!==1||c!==e[0]))if(s)l=!0;else{let d=a*i,u=d-i,f=d+i;for(let g=0;g!==i;++g){let w=t[d+g];if(w!==t[u+g]||w!==t[f+g]){l=!0;break}}}if(l){if(a!==o){e[o]=e[a];let d=a*i,u=o*i;for(let f=0;f!==i;++f)t[u+f]=t[d+f]}++o}}if(r>0){e[o]=e[r];for(let a=r*i,l=o*i,c=0;c!==i;++c)t[l+c]=t[a+c];++o}return o!==e.length?(this.times=e.slice(0,o),this.values=t.slice(0,o*i)):(this.times=e,this.values=t),this}clone(){let e=this.times.slice(),t=this.values.slice(),i=this.constructor,s=new i(this.name,e,t);return s.createInterpolant=this.createInterpolant,ko(this.settings)&&(s.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),s}};function cd(n,e){for(let t=0,i=n.length;t!==i;t+=2)n[t]+=e}function hd(n,e){for(let t=0,i=n.length;t!==i;t+=2)n[t]*=e}un.prototype.ValueTypeName="";un.prototype.TimeBufferType=Float32Array;un.prototype.ValueBufferType=Float32Array;un.prototype.DefaultInterpolation=Zo;var Ci=class extends un{constructor(e,t,i){super(e,t,i)}};Ci.prototype.ValueTypeName="bool";Ci.prototype.ValueBufferType=Array;Ci.prototype.DefaultInterpolation=dr;Ci.prototype.InterpolantFactoryMethodLinear=void 0;Ci.prototype.InterpolantFactoryMethodSmooth=void 0;var la=class extends un{constructor(e,t,i,s){super(e,t,i,s)}};la.prototype.ValueTypeName="color";var ca=class extends un{constructor(e,t,i,s){super(e,t,i,s)}};ca.prototype.ValueTypeName="number";var ha=class extends Ei{constructor(e,t,i,s){super(e,t,i,s)}interpolate_(e,t,i,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=(i-t)/(s-t),c=e*a;for(let h=c+a;c!==h;c+=4)cn.slerpFlat(r,0,o,c-a,o,c,l);return r}},Ar=class extends un{constructor(e,t,i,s){super(e,t,i,s)}InterpolantFactoryMethodLinear(e){return new ha(this.times,this.values,this.getValueSize(),e)}};Ar.prototype.ValueTypeName="quaternion";Ar.prototype.InterpolantFactoryMethodSmooth=void 0;var Ri=class extends un{constructor(e,t,i){super(e,t,i)}};Ri.prototype.ValueTypeName="string";Ri.prototype.ValueBufferType=Array;Ri.prototype.DefaultInterpolation=dr;Ri.prototype.InterpolantFactoryMethodLinear=void 0;Ri.prototype.InterpolantFactoryMethodSmooth=void 0;var ua=class extends un{constructor(e,t,i,s){super(e,t,i,s)}};ua.prototype.ValueTypeName="vector";var da=class{constructor(e,t,i){let s=this,r=!1,o=0,a=0,l,c=[];this.onStart=void 0,this.onLoad=e,this.onProgress=t,this.onError=i,this._abortController=null,this.itemStart=function(h){a++,r===!1&&s.onStart!==void 0&&s.onStart(h,o,a),r=!0},this.itemEnd=function(h){o++,s.onProgress!==void 0&&s.onProgress(h,o,a),o===a&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(h){s.onError!==void 0&&s.onError(h)},this.resolveURL=function(h){return h=h.normalize("NFC"),l?l(h):h},this.setURLModifier=function(h){return l=h,this},this.addHandler=function(h,d){return c.push(h,d),this},this.removeHandler=function(h){let d=c.indexOf(h);return d!==-1&&c.splice(d,2),this},this.getHandler=function(h){for(let d=0,u=c.length;d<u;d+=2){let f=c[d],g=c[d+1];if(f.global&&(f.lastIndex=0),f.test(h))return g}return null},this.abort=function(){return this.abortController.abort(),this._abortController=null,this}}get abortController(){return this._abortController||(this._abortController=new AbortController),this._abortController}},tf=new da,fa=class{constructor(e){this.manager=e!==void 0?e:tf,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={},this.priority="auto",this.cache="default",typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}load(){}loadAsync(e,t){let i=this;return new Promise(function(s,r){i.load(e,s,t,r)})}parse(){}setCrossOrigin(e){return this.crossOrigin=e,this}setWithCredentials(e){return this.withCredentials=e,this}setPath(e){return this.path=e,this}setResourcePath(e){return this.resourcePath=e,this}setRequestHeader(e){return this.requestHeader=e,this}setPriority(e){return this.priority=e,this}setCache(e){return this.cache=e,this}abort(){return this}};fa.DEFAULT_MATERIAL_NAME="__DEFAULT";var Oo=new O,Uo=new cn,Fn=new O,Tr=class extends hn{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new ut,this.projectionMatrix=new ut,this.projectionMatrixInverse=new ut,this.coordinateSystem=bn,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(Oo,Uo,Fn),Fn.x===1&&Fn.y===1&&Fn.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Oo,Uo,Fn.set(1,1,1)).invert()}updateWorldMatrix(e,t,i=!1){super.updateWorldMatrix(e,t,i),this.matrixWorld.decompose(Oo,Uo,Fn),Fn.x===1&&Fn.y===1&&Fn.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(Oo,Uo,Fn.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},Si=new O,ud=new De,dd=new De,qt=class extends Tr{constructor(e=50,t=1,i=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=e,this.zoom=1,this.near=i,this.far=s,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=Ls*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(hr*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return Ls*2*Math.atan(Math.tan(hr*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,i){Si.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(Si.x,Si.y).multiplyScalar(-e/Si.z),Si.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),i.set(Si.x,Si.y).multiplyScalar(-e/Si.z)}getViewSize(e,t){return this.getViewBounds(e,ud,dd),t.subVectors(dd,ud)}setViewOffset(e,t,i,s,r,o){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=i,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(hr*.5*this.fov)/this.zoom,i=2*t,s=this.aspect*i,r=-.5*s,o=this.view;if(this.view!==null&&this.view.enabled){let l=o.fullWidth,c=o.fullHeight;r+=o.offsetX*s/l,t-=o.offsetY*i/c,s*=o.width/l,i*=o.height/c}let a=this.filmOffset;a!==0&&(r+=e*a/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,t,t-i,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}};var Fs=class extends Tr{constructor(e=-1,t=1,i=1,s=-1,r=.1,o=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=i,this.bottom=s,this.near=r,this.far=o,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,i,s,r,o){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=i,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),i=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=i-e,o=i+e,a=s+t,l=s-t;if(this.view!==null&&this.view.enabled){let c=(this.right-this.left)/this.view.fullWidth/this.zoom,h=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,o=r+c*this.view.width,a-=h*this.view.offsetY,l=a-h*this.view.height}this.projectionMatrix.makeOrthographic(r,o,a,l,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}};var Es=-90,Cs=1,zs=class extends hn{constructor(e,t,i){super(),this.type="CubeCamera",this.renderTarget=i,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new qt(Es,Cs,e,t);s.layers=this.layers,this.add(s);let r=new qt(Es,Cs,e,t);r.layers=this.layers,this.add(r);let o=new qt(Es,Cs,e,t);o.layers=this.layers,this.add(o);let a=new qt(Es,Cs,e,t);a.layers=this.layers,this.add(a);let l=new qt(Es,Cs,e,t);l.layers=this.layers,this.add(l);let c=new qt(Es,Cs,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[i,s,r,o,a,l]=t;for(let c of t)this.remove(c);if(e===bn)i.up.set(0,1,0),i.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),o.up.set(0,0,1),o.lookAt(0,-1,0),a.up.set(0,1,0),a.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(e===mr)i.up.set(0,-1,0),i.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),o.up.set(0,0,-1),o.lookAt(0,-1,0),a.up.set(0,-1,0),a.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+e);for(let c of t)this.add(c),c.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:i,activeMipmapLevel:s}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[r,o,a,l,c,h]=this.children,d=e.getRenderTarget(),u=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),g=e.xr.enabled;e.xr.enabled=!1;let w=i.texture.mipmapsAutoUpdate;i.texture.mipmapsAutoUpdate=!1;let p=!1;e.isWebGLRenderer===!0?p=e.state.buffers.depth.getReversed():p=e.reversedDepthBuffer,e.setRenderTarget(i,0,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,r),e.setRenderTarget(i,1,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(i,2,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(i,3,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(i,4,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),i.texture.mipmapsAutoUpdate=w,e.setRenderTarget(i,5,s),p&&e.autoClear===!1&&e.clearDepth(),e.render(t,h),e.setRenderTarget(d,u,f),e.xr.enabled=g,i.texture.needsPMREMUpdate=!0}},pa=class extends qt{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}};var $c="\\[\\]\\.:\\/",ug=new RegExp("["+$c+"]","g"),qc="[^"+$c+"]",dg="[^"+$c.replace("\\.","")+"]",fg=/((?:WC+[\/:])*)/.source.replace("WC",qc),pg=/(WCOD+)?/.source.replace("WCOD",dg),mg=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",qc),gg=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",qc),_g=new RegExp("^"+fg+pg+mg+gg+"$"),vg=["material","materials","bones","map"],uc=class{constructor(e,t,i){let s=i||ft.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,s)}getValue(e,t){this.bind();let i=this._targetGroup.nCachedObjects_,s=this._bindings[i];s!==void 0&&s.getValue(e,t)}setValue(e,t){let i=this._bindings;for(let s=this._targetGroup.nCachedObjects_,r=i.length;s!==r;++s)i[s].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,i=e.length;t!==i;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,i=e.length;t!==i;++t)e[t].unbind()}},ft=class n{constructor(e,t,i){this.path=t,this.parsedPath=i||n.parseTrackName(t),this.node=n.findNode(e,this.parsedPath.nodeName),this.rootNode=e,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(e,t,i){return e&&e.isAnimationObjectGroup?new n.Composite(e,t,i):new n(e,t,i)}static sanitizeNodeName(e){return e.replace(/\s/g,"_").replace(ug,"")}static parseTrackName(e){let t=_g.exec(e);if(t===null)throw new Error("THREE.PropertyBinding: Cannot parse trackName: "+e);let i={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},s=i.nodeName&&i.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=i.nodeName.substring(s+1);vg.indexOf(r)!==-1&&(i.nodeName=i.nodeName.substring(0,s),i.objectName=r)}if(i.propertyName===null||i.propertyName.length===0)throw new Error("THREE.PropertyBinding: can not parse propertyName from trackName: "+e);return i}static findNode(e,t){if(t===void 0||t===""||t==="."||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let i=e.skeleton.getBoneByName(t);if(i!==void 0)return i}if(e.children){let i=function(r){for(let o=0;o<r.length;o++){let a=r[o];if(a.name===t||a.uuid===t)return a;let l=i(a.children);if(l)return l}return null},s=i(e.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)e[t++]=i[s]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)i[s]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)i[s]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let i=this.resolvedProperty;for(let s=0,r=i.length;s!==r;++s)i[s]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let e=this.node,t=this.parsedPath,i=t.objectName,s=t.propertyName,r=t.propertyIndex;if(e||(e=n.findNode(this.rootNode,t.nodeName),this.node=e),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!e){Le("PropertyBinding: No target node found for track: "+this.path+".");return}if(i){let c=t.objectIndex;switch(i){case"materials":if(!e.material){Oe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.materials){Oe("PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}e=e.material.materials;break;case"bones":if(!e.skeleton){Oe("PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}e=e.skeleton.bones;for(let h=0;h<e.length;h++)if(e[h].name===c){c=h;break}break;case"map":if("map"in e){e=e.map;break}if(!e.material){Oe("PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!e.material.map){Oe("PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}e=e.material.map;break;default:if(e[i]===void 0){Oe("PropertyBinding: Can not bind to objectName of node undefined.",this);return}e=e[i]}if(c!==void 0){if(e[c]===void 0){Oe("PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,e);return}e=e[c]}}let o=e[s];if(o===void 0){let c=t.nodeName;Oe("PropertyBinding: Trying to update property for track: "+c+"."+s+" but it wasn't found.",e);return}let a=this.Versioning.None;this.targetObject=e,e.isMaterial===!0?a=this.Versioning.NeedsUpdate:e.isObject3D===!0&&(a=this.Versioning.MatrixWorldNeedsUpdate);let l=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!e.geometry){Oe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!e.geometry.morphAttributes){Oe("PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}e.morphTargetDictionary[r]!==void 0&&(r=e.morphTargetDictionary[r])}l=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=r}else o.fromArray!==void 0&&o.toArray!==void 0?(l=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(l=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=s;this.getValue=this.GetterByBindingType[l],this.setValue=this.SetterByBindingTypeAndVersioning[l][a]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};ft.Composite=uc;ft.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};ft.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};ft.prototype.GetterByBindingType=[ft.prototype._getValue_direct,ft.prototype._getValue_array,ft.prototype._getValue_arrayElement,ft.prototype._getValue_toArray];ft.prototype.SetterByBindingTypeAndVersioning=[[ft.prototype._setValue_direct,ft.prototype._setValue_direct_setNeedsUpdate,ft.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[ft.prototype._setValue_array,ft.prototype._setValue_array_setNeedsUpdate,ft.prototype._setValue_array_setMatrixWorldNeedsUpdate],[ft.prototype._setValue_arrayElement,ft.prototype._setValue_arrayElement_setNeedsUpdate,ft.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[ft.prototype._setValue_fromArray,ft.prototype._setValue_fromArray_setNeedsUpdate,ft.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var uS=new Float32Array(1);var Bs=class{constructor(e=1,t=0,i=0){this.radius=e,this.phi=t,this.theta=i}set(e,t,i){return this.radius=e,this.phi=t,this.theta=i,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){return this.phi=Xe(this.phi,1e-6,Math.PI-1e-6),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,i){return this.radius=Math.sqrt(e*e+t*t+i*i),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,i),this.phi=Math.acos(Xe(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var dc=class{static{this.prototype.isMatrix2=!0}constructor(e,t,i,s){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,i,s)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let i=0;i<4;i++)this.elements[i]=e[i+t];return this}set(e,t,i,s){let r=this.elements;return r[0]=e,r[2]=t,r[1]=i,r[3]=s,this}};var Er=class extends Rn{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function Xc(n,e,t,i){let s=xg(i);switch(t){case Lc:return n*e;case Nc:return n*e/s.components*s.byteLength;case ba:return n*e/s.components*s.byteLength;case Di:return n*e*2/s.components*s.byteLength;case Sa:return n*e*2/s.components*s.byteLength;case Dc:return n*e*3/s.components*s.byteLength;case tn:return n*e*4/s.components*s.byteLength;case wa:return n*e*4/s.components*s.byteLength;case Pr:case Ir:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*8;case Lr:case Dr:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*16;case Aa:case Ea:return Math.max(n,16)*Math.max(e,8)/4;case Ma:case Ta:return Math.max(n,8)*Math.max(e,8)/2;case Ca:case Ra:case Ia:case La:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*8;case Pa:case Nr:case Da:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*16;case Na:return Math.floor((n+3)/4)*Math.floor((e+3)/4)*16;case ka:return Math.floor((n+4)/5)*Math.floor((e+3)/4)*16;case Oa:return Math.floor((n+4)/5)*Math.floor((e+4)/5)*16;case Ua:return Math.floor((n+5)/6)*Math.floor((e+4)/5)*16;case Fa:return Math.floor((n+5)/6)*Math.floor((e+5)/6)*16;case za:return Math.floor((n+7)/8)*Math.floor((e+4)/5)*16;case Ba:return Math.floor((n+7)/8)*Math.floor((e+5)/6)*16;case Va:return Math.floor((n+7)/8)*Math.floor((e+7)/8)*16;case Ga:return Math.floor((n+9)/10)*Math.floor((e+4)/5)*16;case Ha:return Math.floor((n+9)/10)*Math.floor((e+5)/6)*16;case Wa:return Math.floor((n+9)/10)*Math.floor((e+7)/8)*16;case $a:return Math.floor((n+9)/10)*Math.floor((e+9)/10)*16;case qa:return Math.floor((n+11)/12)*Math.floor((e+9)/10)*16;case Xa:return Math.floor((n+11)/12)*Math.floor((e+11)/12)*16;case Ya:case Za:case ja:return Math.ceil(n/4)*Math.ceil(e/4)*16;case Ka:case Ja:return Math.ceil(n/4)*Math.ceil(e/4)*8;case kr:case Qa:return Math.ceil(n/4)*Math.ceil(e/4)*16}throw new Error(`Unable to determine texture byte length for ${t} format.`)}function xg(n){switch(n){case Ht:case Cc:return{byteLength:1,components:1};case Ws:case Rc:case Dn:return{byteLength:2,components:1};case xa:case ya:return{byteLength:2,components:4};case In:case va:case Ln:return{byteLength:4,components:1};case Pc:case Ic:return{byteLength:4,components:3}}throw new Error(`THREE.TextureUtils: Unknown texture type ${n}.`)}typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:"187"}}));typeof window<"u"&&(window.__THREE__?Le("WARNING: Multiple instances of Three.js being imported."):window.__THREE__="187");function Mf(){let n=null,e=!1,t=null,i=null;function s(r,o){i=n.requestAnimationFrame(s),t(r,o)}return{start:function(){e!==!0&&t!==null&&n!==null&&(i=n.requestAnimationFrame(s),e=!0)},stop:function(){n!==null&&n.cancelAnimationFrame(i),e=!1},setAnimationLoop:function(r){t=r},setContext:function(r){n=r}}}function bg(n){let e=new WeakMap;function t(a,l){let c=a.array,h=a.usage,d=c.byteLength,u=n.createBuffer();n.bindBuffer(l,u),n.bufferData(l,c,h),a.onUploadCallback();let f;if(c instanceof Float32Array)f=n.FLOAT;else if(typeof Float16Array<"u"&&c instanceof Float16Array)f=n.HALF_FLOAT;else if(c instanceof Uint16Array)a.isFloat16BufferAttribute?f=n.HALF_FLOAT:f=n.UNSIGNED_SHORT;else if(c instanceof Int16Array)f=n.SHORT;else if(c instanceof Uint32Array)f=n.UNSIGNED_INT;else if(c instanceof Int32Array)f=n.INT;else if(c instanceof Int8Array)f=n.BYTE;else if(c instanceof Uint8Array)f=n.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)f=n.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:u,type:f,bytesPerElement:c.BYTES_PER_ELEMENT,version:a.version,size:d}}function i(a,l,c){let h=l.array,d=l.updateRanges;if(n.bindBuffer(c,a),d.length===0)n.bufferSubData(c,0,h);else{d.sort((f,g)=>f.start-g.start);let u=0;for(let f=1;f<d.length;f++){let g=d[u],w=d[f];w.start<=g.start+g.count+1?g.count=Math.max(g.count,w.start+w.count-g.start):(++u,d[u]=w)}d.length=u+1;for(let f=0,g=d.length;f<g;f++){let w=d[f];n.bufferSubData(c,w.start*h.BYTES_PER_ELEMENT,h,w.start,w.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(a){return a.isInterleavedBufferAttribute&&(a=a.data),e.get(a)}function r(a){a.isInterleavedBufferAttribute&&(a=a.data);let l=e.get(a);l&&(n.deleteBuffer(l.buffer),e.delete(a))}function o(a,l){if(a.isInterleavedBufferAttribute&&(a=a.data),a.isGLBufferAttribute){let h=e.get(a);(!h||h.version<a.version)&&e.set(a,{buffer:a.buffer,type:a.type,bytesPerElement:a.elementSize,version:a.version});return}let c=e.get(a);if(c===void 0)e.set(a,t(a,l));else if(c.version<a.version){if(c.size!==a.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");i(c.buffer,a,l),c.version=a.version}}return{get:s,remove:r,update:o}}var Sg=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,wg=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,Mg=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,Ag=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,Tg=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,Eg=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,Cg=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,Rg=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,Pg=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,Ig=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,Lg=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,Dg=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,Ng=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,kg=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,Og=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,Ug=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,Fg=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,zg=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,Bg=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,Vg=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,Gg=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,Hg=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,Wg=`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,$g=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,qg=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,Xg=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,Yg=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,Zg=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,jg=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,Kg="gl_FragColor = linearToOutputTexel( gl_FragColor );",Jg=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,Qg=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,e0=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,t0=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,n0=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,i0=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,s0=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,r0=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,o0=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,a0=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,l0=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,c0=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,h0=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,u0=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,d0=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,f0=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,p0=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,m0=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,g0=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,_0=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,v0=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,x0=`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,y0=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,b0=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,S0=`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,w0=`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,M0=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,A0=`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,T0=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,E0=`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,C0=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,R0=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,P0=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,I0=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,L0=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,D0=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,N0=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,k0=`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,O0=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,U0=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,F0=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,z0=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,B0=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,V0=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,G0=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,H0=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,W0=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,$0=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,q0=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,X0=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,Y0=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,Z0=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,j0=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,K0=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,J0=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,Q0=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,e_=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,t_=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,n_=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,i_=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,s_=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,r_=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,o_=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,a_=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,l_=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,c_=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,h_=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,u_=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,d_=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,f_=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,p_=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,m_=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,g_=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,__=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,v_=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,x_=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,y_=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,b_=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,S_=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,w_=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,M_=`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,A_=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,T_=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,E_=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,C_=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,R_=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,P_=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,I_=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,L_=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,D_=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,N_=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,k_=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,O_=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,U_=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,F_=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,z_=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,B_=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,V_=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,G_=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,H_=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,W_=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,$_=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,q_=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,X_=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,Y_=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,Z_=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,j_=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,K_=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,J_=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,Q_=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,ev=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,qe={alphahash_fragment:Sg,alphahash_pars_fragment:wg,alphamap_fragment:Mg,alphamap_pars_fragment:Ag,alphatest_fragment:Tg,alphatest_pars_fragment:Eg,aomap_fragment:Cg,aomap_pars_fragment:Rg,batching_pars_vertex:Pg,batching_vertex:Ig,begin_vertex:Lg,beginnormal_vertex:Dg,bsdfs:Ng,iridescence_fragment:kg,bumpmap_pars_fragment:Og,clipping_planes_fragment:Ug,clipping_planes_pars_fragment:Fg,clipping_planes_pars_vertex:zg,clipping_planes_vertex:Bg,color_fragment:Vg,color_pars_fragment:Gg,color_pars_vertex:Hg,color_vertex:Wg,common:$g,defaultnormal_vertex:qg,displacementmap_pars_vertex:Xg,displacementmap_vertex:Yg,emissivemap_fragment:Zg,emissivemap_pars_fragment:jg,colorspace_fragment:Kg,colorspace_pars_fragment:Jg,envmap_fragment:Qg,envmap_common_pars_fragment:e0,envmap_pars_fragment:t0,envmap_pars_vertex:n0,envmap_physical_pars_fragment:f0,envmap_vertex:i0,fog_vertex:s0,fog_pars_vertex:r0,fog_fragment:o0,fog_pars_fragment:a0,gradientmap_pars_fragment:l0,lightmap_pars_fragment:c0,lights_lambert_fragment:h0,lights_lambert_pars_fragment:u0,lights_pars_begin:d0,lights_toon_fragment:p0,lights_toon_pars_fragment:m0,lights_phong_fragment:g0,lights_phong_pars_fragment:_0,lights_physical_fragment:v0,lights_physical_pars_fragment:x0,lights_fragment_begin:y0,lights_fragment_maps:b0,lights_fragment_end:S0,lightprobes_pars_fragment:w0,logdepthbuf_fragment:M0,logdepthbuf_pars_fragment:A0,logdepthbuf_pars_vertex:T0,logdepthbuf_vertex:E0,map_fragment:C0,map_pars_fragment:R0,map_particle_fragment:P0,map_particle_pars_fragment:I0,metalnessmap_fragment:L0,metalnessmap_pars_fragment:D0,morphinstance_vertex:N0,morphcolor_vertex:k0,morphnormal_vertex:O0,morphtarget_pars_vertex:U0,morphtarget_vertex:F0,normal_fragment_begin:z0,normal_fragment_maps:B0,normal_pars_fragment:V0,normal_pars_vertex:G0,normal_vertex:H0,normalmap_pars_fragment:W0,clearcoat_normal_fragment_begin:$0,clearcoat_normal_fragment_maps:q0,clearcoat_pars_fragment:X0,iridescence_pars_fragment:Y0,opaque_fragment:Z0,packing:j0,premultiplied_alpha_fragment:K0,project_vertex:J0,dithering_fragment:Q0,dithering_pars_fragment:e_,roughnessmap_fragment:t_,roughnessmap_pars_fragment:n_,shadowmap_pars_fragment:i_,shadowmap_pars_vertex:s_,shadowmap_vertex:r_,shadowmask_pars_fragment:o_,skinbase_vertex:a_,skinning_pars_vertex:l_,skinning_vertex:c_,skinnormal_vertex:h_,specularmap_fragment:u_,specularmap_pars_fragment:d_,tonemapping_fragment:f_,tonemapping_pars_fragment:p_,transmission_fragment:m_,transmission_pars_fragment:g_,uv_pars_fragment:__,uv_pars_vertex:v_,uv_vertex:x_,worldpos_vertex:y_,background_vert:b_,background_frag:S_,backgroundCube_vert:w_,backgroundCube_frag:M_,cube_vert:A_,cube_frag:T_,depth_vert:E_,depth_frag:C_,distance_vert:R_,distance_frag:P_,equirect_vert:I_,equirect_frag:L_,linedashed_vert:D_,linedashed_frag:N_,meshbasic_vert:k_,meshbasic_frag:O_,meshlambert_vert:U_,meshlambert_frag:F_,meshmatcap_vert:z_,meshmatcap_frag:B_,meshnormal_vert:V_,meshnormal_frag:G_,meshphong_vert:H_,meshphong_frag:W_,meshphysical_vert:$_,meshphysical_frag:q_,meshtoon_vert:X_,meshtoon_frag:Y_,points_vert:Z_,points_frag:j_,shadow_vert:K_,shadow_frag:J_,sprite_vert:Q_,sprite_frag:ev},ge={common:{diffuse:{value:new Ve(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new Ue},alphaMap:{value:null},alphaMapTransform:{value:new Ue},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new Ue}},envmap:{envMap:{value:null},envMapRotation:{value:new Ue},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new Ue}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new Ue}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new Ue},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new Ue},normalScale:{value:new De(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new Ue},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new Ue}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new Ue}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new Ue}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new Ve(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new Ve(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new Ue},alphaTest:{value:0},uvTransform:{value:new Ue}},sprite:{diffuse:{value:new Ve(16777215)},opacity:{value:1},center:{value:new De(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new Ue},alphaMap:{value:null},alphaMapTransform:{value:new Ue},alphaTest:{value:0}}},$n={basic:{uniforms:Wt([ge.common,ge.specularmap,ge.envmap,ge.aomap,ge.lightmap,ge.fog]),vertexShader:qe.meshbasic_vert,fragmentShader:qe.meshbasic_frag},lambert:{uniforms:Wt([ge.common,ge.specularmap,ge.envmap,ge.aomap,ge.lightmap,ge.emissivemap,ge.bumpmap,ge.normalmap,ge.displacementmap,ge.fog,ge.lights,{emissive:{value:new Ve(0)},envMapIntensity:{value:1}}]),vertexShader:qe.meshlambert_vert,fragmentShader:qe.meshlambert_frag},phong:{uniforms:Wt([ge.common,ge.specularmap,ge.envmap,ge.aomap,ge.lightmap,ge.emissivemap,ge.bumpmap,ge.normalmap,ge.displacementmap,ge.fog,ge.lights,{emissive:{value:new Ve(0)},specular:{value:new Ve(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:qe.meshphong_vert,fragmentShader:qe.meshphong_frag},standard:{uniforms:Wt([ge.common,ge.envmap,ge.aomap,ge.lightmap,ge.emissivemap,ge.bumpmap,ge.normalmap,ge.displacementmap,ge.roughnessmap,ge.metalnessmap,ge.fog,ge.lights,{emissive:{value:new Ve(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:qe.meshphysical_vert,fragmentShader:qe.meshphysical_frag},toon:{uniforms:Wt([ge.common,ge.aomap,ge.lightmap,ge.emissivemap,ge.bumpmap,ge.normalmap,ge.displacementmap,ge.gradientmap,ge.fog,ge.lights,{emissive:{value:new Ve(0)}}]),vertexShader:qe.meshtoon_vert,fragmentShader:qe.meshtoon_frag},matcap:{uniforms:Wt([ge.common,ge.bumpmap,ge.normalmap,ge.displacementmap,ge.fog,{matcap:{value:null}}]),vertexShader:qe.meshmatcap_vert,fragmentShader:qe.meshmatcap_frag},points:{uniforms:Wt([ge.points,ge.fog]),vertexShader:qe.points_vert,fragmentShader:qe.points_frag},dashed:{uniforms:Wt([ge.common,ge.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:qe.linedashed_vert,fragmentShader:qe.linedashed_frag},depth:{uniforms:Wt([ge.common,ge.displacementmap]),vertexShader:qe.depth_vert,fragmentShader:qe.depth_frag},normal:{uniforms:Wt([ge.common,ge.bumpmap,ge.normalmap,ge.displacementmap,{opacity:{value:1}}]),vertexShader:qe.meshnormal_vert,fragmentShader:qe.meshnormal_frag},sprite:{uniforms:Wt([ge.sprite,ge.fog]),vertexShader:qe.sprite_vert,fragmentShader:qe.sprite_frag},background:{uniforms:{uvTransform:{value:new Ue},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:qe.background_vert,fragmentShader:qe.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new Ue}},vertexShader:qe.backgroundCube_vert,fragmentShader:qe.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:qe.cube_vert,fragmentShader:qe.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:qe.equirect_vert,fragmentShader:qe.equirect_frag},distance:{uniforms:Wt([ge.common,ge.displacementmap,{referencePosition:{value:new O},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:qe.distance_vert,fragmentShader:qe.distance_frag},shadow:{uniforms:Wt([ge.lights,ge.fog,{color:{value:new Ve(0)},opacity:{value:1}}]),vertexShader:qe.shadow_vert,fragmentShader:qe.shadow_frag}};$n.physical={uniforms:Wt([$n.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new Ue},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new Ue},clearcoatNormalScale:{value:new De(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new Ue},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new Ue},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new Ue},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new Ue},sheen:{value:0},sheenColor:{value:new Ve(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new Ue},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new Ue},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new Ue},transmissionSamplerSize:{value:new De},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new Ue},attenuationDistance:{value:0},attenuationColor:{value:new Ve(0)},specularColor:{value:new Ve(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new Ue},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new Ue},anisotropyVector:{value:new De},anisotropyMap:{value:null},anisotropyMapTransform:{value:new Ue}}]),vertexShader:qe.meshphysical_vert,fragmentShader:qe.meshphysical_frag};var el={r:0,b:0,g:0},tv=new ut,Af=new Ue;Af.set(-1,0,0,0,1,0,0,0,1);function nv(n,e,t,i,s,r){let o=new Ve(0),a=s===!0?0:1,l,c,h=null,d=0,u=null;function f(S){let R=S.isScene===!0?S.background:null;if(R&&R.isTexture){let T=S.backgroundBlurriness>0;R=e.get(R,T)}return R}function g(S){let R=!1,T=f(S);T===null?p(o,a):T&&T.isColor&&(p(T,1),R=!0);let M=n.xr.getEnvironmentBlendMode();M==="additive"?t.buffers.color.setClear(0,0,0,1,r):M==="alpha-blend"&&t.buffers.color.setClear(0,0,0,0,r),(n.autoClear||R)&&(t.buffers.depth.setTest(!0),t.buffers.depth.setMask(!0),t.buffers.color.setMask(!0),n.clear(n.autoClearColor,n.autoClearDepth,n.autoClearStencil))}function w(S,R){let T=f(R);T&&T.isCubeTexture?(c===void 0&&(c=new Zt(new Us(1,1,1),new Vn({name:"BackgroundCubeMaterial",uniforms:rs($n.backgroundCube.uniforms),vertexShader:$n.backgroundCube.vertexShader,fragmentShader:$n.backgroundCube.fragmentShader,side:jt,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute("normal"),c.geometry.deleteAttribute("uv"),c.onBeforeRender=function(M,E,_){this.matrixWorld.copyPosition(_.matrixWorld)},Object.defineProperty(c.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),i.update(c)),c.material.uniforms.envMap.value=T,c.material.uniforms.backgroundBlurriness.value=R.backgroundBlurriness,c.material.uniforms.backgroundIntensity.value=R.backgroundIntensity,c.material.uniforms.backgroundRotation.value.setFromMatrix4(tv.makeRotationFromEuler(R.backgroundRotation)).transpose(),T.isRenderTargetTexture===!1&&c.material.uniforms.backgroundRotation.value.premultiply(Af),c.material.toneMapped=Ke.getTransfer(T.colorSpace)!==st,(h!==T||d!==T.version||u!==n.toneMapping)&&(c.material.needsUpdate=!0,h=T,d=T.version,u=n.toneMapping),c.layers.enableAll(),S.unshift(c,c.geometry,c.material,0,0,null)):T&&T.isTexture&&(l===void 0&&(l=new Zt(new Mr(2,2),new Vn({name:"BackgroundMaterial",uniforms:rs($n.background.uniforms),vertexShader:$n.background.vertexShader,fragmentShader:$n.background.fragmentShader,side:Li,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute("normal"),Object.defineProperty(l.material,"map",{get:function(){return this.uniforms.t2D.value}}),i.update(l)),l.material.uniforms.t2D.value=T,l.material.uniforms.backgroundIntensity.value=R.backgroundIntensity,l.material.toneMapped=Ke.getTransfer(T.colorSpace)!==st,T.matrixAutoUpdate===!0&&T.updateMatrix(),l.material.uniforms.uvTransform.value.copy(T.matrix),(h!==T||d!==T.version||u!==n.toneMapping)&&(l.material.needsUpdate=!0,h=T,d=T.version,u=n.toneMapping),l.layers.enableAll(),S.unshift(l,l.geometry,l.material,0,0,null))}function p(S,R){S.getRGB(el,Wc(n)),t.buffers.color.setClear(el.r,el.g,el.b,R,r)}function m(){c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0),l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0)}return{getClearColor:function(){return o},setClearColor:function(S,R=1){o.set(S),a=R,p(o,a)},getClearAlpha:function(){return a},setClearAlpha:function(S){a=S,p(o,a)},render:g,addToRenderList:w,dispose:m}}function iv(n,e){let t=n.getParameter(n.MAX_VERTEX_ATTRIBS),i={},s=u(null),r=s,o=!1;function a(U,V,q,I,H){let Z=!1,W=d(U,I,q,V);r!==W&&(r=W,c(r.object)),Z=f(U,I,q,H),Z&&g(U,I,q,H),H!==null&&e.update(H,n.ELEMENT_ARRAY_BUFFER),(Z||o)&&(o=!1,T(U,V,q,I),H!==null&&n.bindBuffer(n.ELEMENT_ARRAY_BUFFER,e.get(H).buffer))}function l(){return n.createVertexArray()}function c(U){return n.bindVertexArray(U)}function h(U){return n.deleteVertexArray(U)}function d(U,V,q,I){let H=I.wireframe===!0,Z=i[V.id];Z===void 0&&(Z={},i[V.id]=Z);let W=U.isInstancedMesh===!0?U.id:0,ie=Z[W];ie===void 0&&(ie={},Z[W]=ie);let Y=ie[q.id];Y===void 0&&(Y={},ie[q.id]=Y);let te=Y[H];return te===void 0&&(te=u(l()),Y[H]=te),te}function u(U){let V=[],q=[],I=[];for(let H=0;H<t;H++)V[H]=0,q[H]=0,I[H]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:V,enabledAttributes:q,attributeDivisors:I,object:U,attributes:{},index:null}}function f(U,V,q,I){let H=r.attributes,Z=V.attributes,W=0,ie=q.getAttributes();for(let Y in ie)if(ie[Y].location>=0){let ne=H[Y],Ae=Z[Y];if(Ae===void 0&&(Y==="instanceMatrix"&&U.instanceMatrix&&(Ae=U.instanceMatrix),Y==="instanceColor"&&U.instanceColor&&(Ae=U.instanceColor)),ne===void 0||ne.attribute!==Ae||Ae&&ne.data!==Ae.data)return!0;W++}return r.attributesNum!==W||r.index!==I}function g(U,V,q,I){let H={},Z=V.attributes,W=0,ie=q.getAttributes();for(let Y in ie)if(ie[Y].location>=0){let ne=Z[Y];ne===void 0&&(Y==="instanceMatrix"&&U.instanceMatrix&&(ne=U.instanceMatrix),Y==="instanceColor"&&U.instanceColor&&(ne=U.instanceColor));let Ae={};Ae.attribute=ne,ne&&ne.data&&(Ae.data=ne.data),H[Y]=Ae,W++}r.attributes=H,r.attributesNum=W,r.index=I}function w(){let U=r.newAttributes;for(let V=0,q=U.length;V<q;V++)U[V]=0}function p(U){m(U,0)}function m(U,V){let q=r.newAttributes,I=r.enabledAttributes,H=r.attributeDivisors;q[U]=1,I[U]===0&&(n.enableVertexAttribArray(U),I[U]=1),H[U]!==V&&(n.vertexAttribDivisor(U,V),H[U]=V)}function S(){let U=r.newAttributes,V=r.enabledAttributes;for(let q=0,I=V.length;q<I;q++)V[q]!==U[q]&&(n.disableVertexAttribArray(q),V[q]=0)}function R(U,V,q,I,H,Z,W){W===!0?n.vertexAttribIPointer(U,V,q,H,Z):n.vertexAttribPointer(U,V,q,I,H,Z)}function T(U,V,q,I){w();let H=I.attributes,Z=q.getAttributes(),W=V.defaultAttributeValues;for(let ie in Z){let Y=Z[ie];if(Y.location>=0){let te=H[ie];if(te===void 0&&(ie==="instanceMatrix"&&U.instanceMatrix&&(te=U.instanceMatrix),ie==="instanceColor"&&U.instanceColor&&(te=U.instanceColor)),te!==void 0){let ne=te.normalized,Ae=te.itemSize,ze=e.get(te);if(ze===void 0)continue;let J=ze.buffer,_e=ze.type,Se=ze.bytesPerElement,Re=_e===n.INT||_e===n.UNSIGNED_INT||te.gpuType===va;if(te.isInterleavedBufferAttribute){let ve=te.data,Ge=ve.isInterleavedBuffer===!0?ve.stride:ve.itemSize,bt=te.offset;if(ve.isInstancedInterleavedBuffer||ve.isInstancedBufferAttribute){for(let Ne=0;Ne<Y.locationSize;Ne++)m(Y.location+Ne,ve.meshPerAttribute);U.isInstancedMesh!==!0&&I._maxInstanceCount===void 0&&(I._maxInstanceCount=ve.meshPerAttribute*ve.count)}else for(let Ne=0;Ne<Y.locationSize;Ne++)p(Y.location+Ne);n.bindBuffer(n.ARRAY_BUFFER,J);for(let Ne=0;Ne<Y.locationSize;Ne++)R(Y.location+Ne,Ae/Y.locationSize,_e,ne,Ge*Se,(bt+Ae/Y.locationSize*Ne)*Se,Re)}else{if(te.isInstancedBufferAttribute){for(let ve=0;ve<Y.locationSize;ve++)m(Y.location+ve,te.meshPerAttribute);U.isInstancedMesh!==!0&&I._maxInstanceCount===void 0&&(I._maxInstanceCount=te.meshPerAttribute*te.count)}else for(let ve=0;ve<Y.locationSize;ve++)p(Y.location+ve);n.bindBuffer(n.ARRAY_BUFFER,J);for(let ve=0;ve<Y.locationSize;ve++)R(Y.location+ve,Ae/Y.locationSize,_e,ne,Ae*Se,Ae/Y.locationSize*ve*Se,Re)}}else if(W!==void 0){let ne=W[ie];if(ne!==void 0)switch(ne.length){case 2:n.vertexAttrib2fv(Y.location,ne);break;case 3:n.vertexAttrib3fv(Y.location,ne);break;case 4:n.vertexAttrib4fv(Y.location,ne);break;default:n.vertexAttrib1fv(Y.location,ne)}}}}S()}function M(){F();for(let U in i){let V=i[U];for(let q in V){let I=V[q];for(let H in I){let Z=I[H];for(let W in Z)h(Z[W].object),delete Z[W];delete I[H]}}delete i[U]}}function E(U){if(i[U.id]===void 0)return;let V=i[U.id];for(let q in V){let I=V[q];for(let H in I){let Z=I[H];for(let W in Z)h(Z[W].object),delete Z[W];delete I[H]}}delete i[U.id]}function _(U){for(let V in i){let q=i[V];for(let I in q){let H=q[I];if(H[U.id]===void 0)continue;let Z=H[U.id];for(let W in Z)h(Z[W].object),delete Z[W];delete H[U.id]}}}function A(U){for(let V in i){let q=i[V],I=U.isInstancedMesh===!0?U.id:0,H=q[I];if(H!==void 0){for(let Z in H){let W=H[Z];for(let ie in W)h(W[ie].object),delete W[ie];delete H[Z]}delete q[I],Object.keys(q).length===0&&delete i[V]}}}function F(){N(),o=!0,r!==s&&(r=s,c(r.object))}function N(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:a,reset:F,resetDefaultState:N,dispose:M,releaseStatesOfGeometry:E,releaseStatesOfObject:A,releaseStatesOfProgram:_,initAttributes:w,enableAttribute:p,disableUnusedAttributes:S}}function sv(n,e,t){let i;function s(l){i=l}function r(l,c){n.drawArrays(i,l,c),t.update(c,i,1)}function o(l,c,h){h!==0&&(n.drawArraysInstanced(i,l,c,h),t.update(c,i,h))}function a(l,c,h){if(h===0)return;e.get("WEBGL_multi_draw").multiDrawArraysWEBGL(i,l,0,c,0,h);let u=0;for(let f=0;f<h;f++)u+=c[f];t.update(u,i,1)}this.setMode=s,this.render=r,this.renderInstances=o,this.renderMultiDraw=a}function rv(n,e,t,i){let s;function r(){if(s!==void 0)return s;if(e.has("EXT_texture_filter_anisotropic")===!0){let _=e.get("EXT_texture_filter_anisotropic");s=n.getParameter(_.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function o(_){return!(_!==tn&&i.convert(_)!==n.getParameter(n.IMPLEMENTATION_COLOR_READ_FORMAT))}function a(_){let A=_===Dn&&(e.has("EXT_color_buffer_half_float")||e.has("EXT_color_buffer_float"));return!(_!==Ht&&_!==Ln&&!A&&i.convert(_)!==n.getParameter(n.IMPLEMENTATION_COLOR_READ_TYPE))}function l(_){if(_==="highp"){if(n.getShaderPrecisionFormat(n.VERTEX_SHADER,n.HIGH_FLOAT).precision>0&&n.getShaderPrecisionFormat(n.FRAGMENT_SHADER,n.HIGH_FLOAT).precision>0)return"highp";_="mediump"}return _==="mediump"&&n.getShaderPrecisionFormat(n.VERTEX_SHADER,n.MEDIUM_FLOAT).precision>0&&n.getShaderPrecisionFormat(n.FRAGMENT_SHADER,n.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=t.precision!==void 0?t.precision:"highp",h=l(c);h!==c&&(Le("WebGLRenderer:",c,"not supported, using",h,"instead."),c=h);let d=t.reversedDepthBuffer===!0&&e.has("EXT_clip_control"),u=t.logarithmicDepthBuffer===!0&&d===!1;t.reversedDepthBuffer===!0&&d===!1&&Le("WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer."),t.logarithmicDepthBuffer===!0&&d===!0&&Le("WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.");let f=n.getParameter(n.MAX_TEXTURE_IMAGE_UNITS),g=n.getParameter(n.MAX_VERTEX_TEXTURE_IMAGE_UNITS),w=n.getParameter(n.MAX_TEXTURE_SIZE),p=n.getParameter(n.MAX_CUBE_MAP_TEXTURE_SIZE),m=n.getParameter(n.MAX_VERTEX_ATTRIBS),S=n.getParameter(n.MAX_VERTEX_UNIFORM_VECTORS),R=n.getParameter(n.MAX_VARYING_VECTORS),T=n.getParameter(n.MAX_FRAGMENT_UNIFORM_VECTORS),M=n.getParameter(n.MAX_SAMPLES),E=n.getParameter(n.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:o,textureTypeReadable:a,precision:c,logarithmicDepthBuffer:u,reversedDepthBuffer:d,maxTextures:f,maxVertexTextures:g,maxTextureSize:w,maxCubemapSize:p,maxAttributes:m,maxVertexUniforms:S,maxVaryings:R,maxFragmentUniforms:T,maxSamples:M,samples:E}}function ov(n){let e=this,t=null,i=0,s=!1,r=!1,o=new ln,a=new Ue,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(d,u){let f=d.length!==0||u||i!==0||s;return s=u,i=d.length,f},this.beginShadows=function(){r=!0,h(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(d,u){t=h(d,u,0)},this.setState=function(d,u,f){let g=d.clippingPlanes,w=d.clipIntersection,p=d.clipShadows,m=n.get(d);if(!s||g===null||g.length===0||r&&!p)r?h(null):c();else{let S=r?0:i,R=S*4,T=m.clippingState||null;l.value=T,T=h(g,u,R,f);for(let M=0;M!==R;++M)T[M]=t[M];m.clippingState=T,this.numIntersection=w?this.numPlanes:0,this.numPlanes+=S}};function c(){l.value!==t&&(l.value=t,l.needsUpdate=i>0),e.numPlanes=i,e.numIntersection=0}function h(d,u,f,g){let w=d!==null?d.length:0,p=null;if(w!==0){if(p=l.value,g!==!0||p===null){let m=f+w*4,S=u.matrixWorldInverse;a.getNormalMatrix(S),(p===null||p.length<m)&&(p=new Float32Array(m));for(let R=0,T=f;R!==w;++R,T+=4)o.copy(d[R]).applyMatrix4(S,a),o.normal.toArray(p,T),p[T+3]=o.constant}l.value=p,l.needsUpdate=!0}return e.numPlanes=w,e.numIntersection=0,p}}var Fr=class extends Yt{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let i={width:e,height:e,depth:1},s=[i,i,i,i,i,i];this.texture=new br(s),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let i={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new Us(5,5,5),r=new Vn({name:"CubemapFromEquirect",uniforms:rs(i.uniforms),vertexShader:i.vertexShader,fragmentShader:i.fragmentShader,side:jt,blending:ts});r.uniforms.tEquirect.value=t;let o=new Zt(s,r),a=t.minFilter;return t.minFilter===oi&&(t.minFilter=Xt),new zs(1,10,this).update(e,o),t.minFilter=a,o.geometry.dispose(),o.material.dispose(),this}clear(e,t=!0,i=!0,s=!0){let r=e.getRenderTarget();for(let o=0;o<6;o++)e.setRenderTarget(this,o),e.clear(t,i,s);e.setRenderTarget(r)}},nf=256,av=3,lv=20,Tf=256,Ef=16,cv=3,hv=new O,uv=new Ve,nl=class n{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new zs(1,10,null),this._boxMesh=new Zt(new Us(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,i=.1,s=100,r={}){let{size:o=256,position:a=hv}=r,l=this._renderer;this._setSize(o);let c=this._allocateTarget(),h=this._getSourceTarget(!0);t>0&&(h.texture.mipmapsAutoUpdate=!1);let d=l.autoClear,u=l.autoClearColor,f=l.autoClearDepth,g=l.autoClearStencil,w=e.background;l.autoClear=!0,l.autoClearColor=!0,l.autoClearDepth=!0,l.autoClearStencil=!0,w===null&&(e.background=l.getClearColor(uv));let p=new zs(i,s,h);return p.position.copy(a),p.update(l,e),l.autoClear=d,l.autoClearColor=u,l.autoClearDepth=f,l.autoClearStencil=g,e.background=w,t>0&&(h.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=of(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=rf(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(nf,Vc(e))}_fromTexture(e,t){e.mapping===is||e.mapping===Hs?this._setSize(e.image.length===0?nf:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let i=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(i),i}_allocateTarget(){let e=this._cubeSize,t=sf(e,!1,!1),i=Math.log2(e)-av;for(let s=0;s<=i;s++)t.texture.mipmaps.push({width:e>>s,height:e>>s});return t.texture.name="PMREM",t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,i=this._sourceTarget;return(i===null||i.width!==t||e&&i.depthBuffer===!1)&&(i!==null&&i.dispose(),this._sourceTarget=sf(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,i){let s=this._boxMesh,r=this._cubeCamera;s.material=i,r.renderTarget=e,r.activeMipmapLevel=t;let o=e.width>>t;e.viewport.set(0,0,o,o),r.update(this._renderer,s),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===is||e.mapping===Hs?(this._cubemapMaterial===null&&(this._cubemapMaterial=of()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=rf()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(e){this._ggxMaterial===null&&(this._ggxMaterial=dv(),this._integrationMaterial=fv());let t=this._cubeSize,i=e.texture.mipmaps.length-1,s=this._ggxMaterial.uniforms;s.envMap.value=this._sourceTarget.texture;let r=this._integrationMaterial.uniforms;r.envMap.value=this._sourceTarget.texture,r.sourceLod.value=Math.log2(t/Ef);for(let o=0;o<=i;o++){let a=n.lodToRoughness(o,i);if(o>i-cv)r.roughness.value=a,this._renderCube(e,o,this._integrationMaterial);else{let l=a>0?Math.log2(t)+.5*Math.log2(6/(Tf*Math.pow(a,4)))+.5:0;s.roughness.value=a,s.lodBias.value=l,this._renderCube(e,o,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=pv());let i=this._blurMaterial,s=i.uniforms,r=this._sourceTarget;s.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,s.envMap.value=r.texture,this._renderCube(e,0,i),s.envMap.value=e.texture,this._renderCube(r,0,i)}};function sf(n,e,t){return new Fr(n,{minFilter:oi,generateMipmaps:e,type:Dn,colorSpace:fr,depthBuffer:t})}function zr(n,e,t){return new Vn({name:n,uniforms:e,vertexShader:qe.cube_vert,fragmentShader:t,side:jt,blending:ts,depthTest:!1,depthWrite:!1})}function dv(){return zr("PMREMGGXConvolution",{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${Tf}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function fv(){return zr("PMREMGGXIntegration",{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:Ef}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function pv(){return zr("PMREMSphericalGaussianBlur",{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${lv}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function rf(){return zr("PMREMEquirectangularToCubemap",{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function of(){return zr("PMREMCubemapToCubemap",{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function mv(n){let e=new WeakMap,t=new WeakMap,i=null;function s(u,f=!1){return u==null?null:f?o(u):r(u)}function r(u){if(u&&u.isTexture){let f=u.mapping;if(f===ma||f===ga)if(e.has(u)){let g=e.get(u).texture;return a(g,u.mapping)}else{let g=u.image;if(g&&g.height>0){let w=new Fr(g.height);return w.fromEquirectangularTexture(n,u),e.set(u,w),u.addEventListener("dispose",c),a(w.texture,u.mapping)}else return null}}return u}function o(u){if(u&&u.isTexture&&u.isPMREMTexture!==!0){let f=u.mapping,g=f===ma||f===ga,w=f===is||f===Hs;if(g||w){let p=t.get(u),m=p!==void 0?p.texture.pmremVersion:0;if(u.isRenderTargetTexture&&u.pmremVersion!==m)return i===null&&(i=new nl(n)),p=g?i.fromEquirectangular(u,p):i.fromCubemap(u,p),p.texture.pmremVersion=u.pmremVersion,t.set(u,p),p.texture;if(p!==void 0)return p.texture;{let S=u.image;return g&&S&&S.height>0||w&&S&&l(S)?(i===null&&(i=new nl(n)),p=g?i.fromEquirectangular(u):i.fromCubemap(u),p.texture.pmremVersion=u.pmremVersion,t.set(u,p),u.addEventListener("dispose",h),p.texture):null}}}return u}function a(u,f){return f===ma?u.mapping=is:f===ga&&(u.mapping=Hs),u}function l(u){let f=0,g=6;for(let w=0;w<g;w++)u[w]!==void 0&&f++;return f===g}function c(u){let f=u.target;f.removeEventListener("dispose",c);let g=e.get(f);g!==void 0&&(e.delete(f),g.dispose())}function h(u){let f=u.target;f.removeEventListener("dispose",h);let g=t.get(f);g!==void 0&&(t.delete(f),g.dispose())}function d(){e=new WeakMap,t=new WeakMap,i!==null&&(i.dispose(),i=null)}return{get:s,dispose:d}}function gv(n){let e={};function t(i){if(e[i]!==void 0)return e[i];let s=n.getExtension(i);return e[i]=s,s}return{has:function(i){return t(i)!==null},init:function(){t("EXT_color_buffer_float"),t("WEBGL_clip_cull_distance"),t("OES_texture_float_linear"),t("EXT_color_buffer_half_float"),t("WEBGL_multisampled_render_to_texture"),t("WEBGL_render_shared_exponent")},get:function(i){let s=t(i);return s===null&&cr("WebGLRenderer: "+i+" extension not supported."),s}}}function _v(n,e,t,i){let s={},r=new WeakMap,o=new FinalizationRegistry(g=>delete s[g]);function a(g){l(g.target)}function l(g){g.index!==null&&e.remove(g.index);for(let p in g.attributes)e.remove(g.attributes[p]);g.removeEventListener("dispose",a),delete s[g.id],o.unregister(g);let w=r.get(g);w&&(e.remove(w),r.delete(g)),i.releaseStatesOfGeometry(g),g.isInstancedBufferGeometry===!0&&delete g._maxInstanceCount,t.memory.geometries--}function c(g,w){return s[w.id]!==void 0||(w.addEventListener("dispose",a),s[w.id]=new WeakRef(w),o.register(w,w.id,w),t.memory.geometries++),w}function h(g){let w=g.attributes;for(let p in w)e.update(w[p],n.ARRAY_BUFFER)}function d(g){let w=g.index,p=g.attributes.position,m=0;if(p===void 0)return;let S=w!==null?w.array.length:p.array.length/3-1,R=p.count>=65535?yr:xr,T=new R(Math.ceil(S/3)*6,1),M=T.array;if(w!==null){let _=w.array;m=w.version;for(let A=0,F=0;A<S;A+=3){let N=_[A+0],U=_[A+1],V=_[A+2];M[F++]=N,M[F++]=U,M[F++]=U,M[F++]=V,M[F++]=V,M[F++]=N}}else{m=p.version;for(let _=0,A=0;_<S;_+=3){let F=_+0,N=_+1,U=_+2;M[A++]=F,M[A++]=N,M[A++]=N,M[A++]=U,M[A++]=U,M[A++]=F}}T.version=m;let E=r.get(g);E&&e.remove(E),r.set(g,T)}function u(g){let w=r.get(g);if(w){let p=g.index;p!==null&&w.version<p.version&&d(g)}else d(g);return r.get(g)}function f(){for(let g in s){let w=s[g].deref();w!==void 0&&l(w)}}return{get:c,update:h,getWireframeAttribute:u,dispose:f}}function vv(n,e,t){let i;function s(d){i=d}let r,o;function a(d){r=d.type,o=d.bytesPerElement}function l(d,u){n.drawElements(i,u,r,d*o),t.update(u,i,1)}function c(d,u,f){f!==0&&(n.drawElementsInstanced(i,u,r,d*o,f),t.update(u,i,f))}function h(d,u,f){if(f===0)return;e.get("WEBGL_multi_draw").multiDrawElementsWEBGL(i,u,0,r,d,0,f);let w=0;for(let p=0;p<f;p++)w+=u[p];t.update(w,i,1)}this.setMode=s,this.setIndex=a,this.render=l,this.renderInstances=c,this.renderMultiDraw=h}function xv(n){let e={geometries:0,textures:0},t={frame:0,calls:0,triangles:0,points:0,lines:0};function i(r,o,a){switch(t.calls++,o){case n.TRIANGLES:t.triangles+=a*(r/3);break;case n.LINES:t.lines+=a*(r/2);break;case n.LINE_STRIP:t.lines+=a*(r-1);break;case n.LINE_LOOP:t.lines+=a*r;break;case n.POINTS:t.points+=a*r;break;default:Oe("WebGLInfo: Unknown draw mode:",o);break}}function s(){t.calls=0,t.triangles=0,t.points=0,t.lines=0}return{memory:e,render:t,programs:null,autoReset:!0,reset:s,update:i}}function yv(n,e,t){let i=new WeakMap,s=new vt;function r(o,a,l){let c=o.morphTargetInfluences,h=a.morphAttributes.position||a.morphAttributes.normal||a.morphAttributes.color,d=h!==void 0?h.length:0,u=i.get(a);if(u===void 0||u.count!==d){let F=function(){_.dispose(),i.delete(a),a.removeEventListener("dispose",F)};u!==void 0&&u.texture.dispose();let f=a.morphAttributes.position!==void 0,g=a.morphAttributes.normal!==void 0,w=a.morphAttributes.color!==void 0,p=a.morphAttributes.position||[],m=a.morphAttributes.normal||[],S=a.morphAttributes.color||[],R=0;f===!0&&(R=1),g===!0&&(R=2),w===!0&&(R=3);let T=a.attributes.position.count*R,M=1;T>e.maxTextureSize&&(M=Math.ceil(T/e.maxTextureSize),T=e.maxTextureSize);let E=new Float32Array(T*M*4*d),_=new _r(E,T,M,d);_.type=Ln,_.needsUpdate=!0;let A=R*4;for(let N=0;N<d;N++){let U=p[N],V=m[N],q=S[N],I=T*M*4*N;for(let H=0;H<U.count;H++){let Z=H*A;f===!0&&(s.fromBufferAttribute(U,H),E[I+Z+0]=s.x,E[I+Z+1]=s.y,E[I+Z+2]=s.z,E[I+Z+3]=0),g===!0&&(s.fromBufferAttribute(V,H),E[I+Z+4]=s.x,E[I+Z+5]=s.y,E[I+Z+6]=s.z,E[I+Z+7]=0),w===!0&&(s.fromBufferAttribute(q,H),E[I+Z+8]=s.x,E[I+Z+9]=s.y,E[I+Z+10]=s.z,E[I+Z+11]=q.itemSize===4?s.w:1)}}u={count:d,texture:_,size:new De(T,M)},i.set(a,u),a.addEventListener("dispose",F)}if(o.isInstancedMesh===!0&&o.morphTexture!==null)l.getUniforms().setValue(n,"morphTexture",o.morphTexture,t);else{let f=0;for(let w=0;w<c.length;w++)f+=c[w];let g=a.morphTargetsRelative?1:1-f;l.getUniforms().setValue(n,"morphTargetBaseInfluence",g),l.getUniforms().setValue(n,"morphTargetInfluences",c)}l.getUniforms().setValue(n,"morphTargetsTexture",u.texture,t),l.getUniforms().setValue(n,"morphTargetsTextureSize",u.size)}return{update:r}}function bv(n,e,t,i,s){let r=new WeakMap;function o(c){let h=s.render.frame,d=c.geometry,u=e.get(c,d);if(r.get(u)!==h&&(e.update(u),r.set(u,h)),c.isInstancedMesh&&(c.hasEventListener("dispose",l)===!1&&c.addEventListener("dispose",l),r.get(c)!==h&&(t.update(c.instanceMatrix,n.ARRAY_BUFFER),c.instanceColor!==null&&t.update(c.instanceColor,n.ARRAY_BUFFER),r.set(c,h))),c.isSkinnedMesh){let f=c.skeleton;r.get(f)!==h&&(f.update(),r.set(f,h))}return u}function a(){r=new WeakMap}function l(c){let h=c.target;h.removeEventListener("dispose",l),i.releaseStatesOfObject(h),t.remove(h.instanceMatrix),h.instanceColor!==null&&t.remove(h.instanceColor)}return{update:o,dispose:a}}var Sv={[yc]:"LINEAR_TONE_MAPPING",[bc]:"REINHARD_TONE_MAPPING",[Sc]:"CINEON_TONE_MAPPING",[wc]:"ACES_FILMIC_TONE_MAPPING",[Ac]:"AGX_TONE_MAPPING",[Tc]:"NEUTRAL_TONE_MAPPING",[Mc]:"CUSTOM_TONE_MAPPING"};function wv(n,e,t,i,s,r){let o=new Yt(e,t,{type:n,depthBuffer:s,stencilBuffer:r,samples:i?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),a=null,l=null,c=null,h=new Gt;h.setAttribute("position",new Sn([-1,3,0,-1,-1,0,3,-1,0],3)),h.setAttribute("uv",new Sn([0,2,0,0,2,0],2));let d=new Pn({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),u=new Zt(h,d),f=new Fs(-1,1,1,-1,0,1),g=null,w=null,p=!1,m,S=null,R=[],T=!1;this.setSize=function(M,E){o.setSize(M,E),a!==null&&a.setSize(M,E),l!==null&&l.setSize(M,E);for(let _=0;_<R.length;_++){let A=R[_];A.setSize&&A.setSize(M,E)}},this.setEffects=function(M){R=M,T=R.length>0&&R[0].isRenderPass===!0;let E=o.width,_=o.height;R.length>0&&a===null&&(a=new Yt(E,_,{type:Dn,depthBuffer:!1,stencilBuffer:!1}),l=new Yt(E,_,{type:Dn,depthBuffer:!1,stencilBuffer:!1}));let A=s===!0&&R.some(F=>F.needsDepthTexture===!0);A!==(o.depthTexture!==null)&&(A===!0&&c===null&&(c=new ri(E,_),r===!0&&(c.format=ai,c.type=ss)),o.dispose(),o.depthTexture=A?c:null,o.resolveDepthBuffer=A,o.storeMultisampledDepthBuffer=A);for(let F=0;F<R.length;F++){let N=R[F];N.setSize&&N.setSize(E,_),A&&N.needsDepthTexture===!0&&N.setDepthTexture&&N.setDepthTexture(c)}},this.begin=function(M,E){if(p||M.toneMapping===Gn&&R.length===0)return!1;if(S=E,E!==null){let _=E.width,A=E.height;(o.width!==_||o.height!==A)&&this.setSize(_,A)}return T===!1&&M.setRenderTarget(o),m=M.toneMapping,M.toneMapping=Gn,!0},this.hasRenderPass=function(){return T},this.end=function(M,E){M.toneMapping=m,p=!0;let _=o,A=a;for(let F=0;F<R.length;F++){let N=R[F];N.enabled!==!1&&(N.render(M,A,_,E),N.needsSwap!==!1&&(_=A,A=A===a?l:a))}if(g!==M.outputColorSpace||w!==M.toneMapping){g=M.outputColorSpace,w=M.toneMapping,d.defines={},Ke.getTransfer(g)===st&&(d.defines.SRGB_TRANSFER="");let F=Sv[w];F&&(d.defines[F]=""),d.needsUpdate=!0}d.uniforms.tDiffuse.value=_.texture,M.setRenderTarget(S),M.render(u,f),S=null,p=!1},this.isCompositing=function(){return p},this.dispose=function(){o.dispose(),a!==null&&a.dispose(),l!==null&&l.dispose(),h.dispose(),d.dispose()}}var Cf=new en,Rf=new ri(1,1),Pf=new Sr(1),If=new _r,Lf=new Jo,Df=new br,af=[],lf=[],cf=new Float32Array(16),hf=new Float32Array(9),uf=new Float32Array(4);function Xs(n,e,t){let i=n[0];if(i<=0||i>0)return n;let s=e*t,r=af[s];if(r===void 0&&(r=new Float32Array(s),af[s]=r),e!==0){i.toArray(r,0);for(let o=1,a=0;o!==e;++o)a+=t,n[o].toArray(r,a)}return r}function Ct(n,e){if(n.length!==e.length)return!1;for(let t=0,i=n.length;t<i;t++)if(n[t]!==e[t])return!1;return!0}function Rt(n,e){for(let t=0,i=e.length;t<i;t++)n[t]=e[t]}function sl(n,e){let t=lf[e];t===void 0&&(t=new Int32Array(e),lf[e]=t);for(let i=0;i!==e;++i)t[i]=n.allocateTextureUnit();return t}function Mv(n,e){let t=this.cache;t[0]!==e&&(n.uniform1f(this.addr,e),t[0]=e)}function Av(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(n.uniform2f(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Ct(t,e))return;n.uniform2fv(this.addr,e),Rt(t,e)}}function Tv(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(n.uniform3f(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else if(e.r!==void 0)(t[0]!==e.r||t[1]!==e.g||t[2]!==e.b)&&(n.uniform3f(this.addr,e.r,e.g,e.b),t[0]=e.r,t[1]=e.g,t[2]=e.b);else{if(Ct(t,e))return;n.uniform3fv(this.addr,e),Rt(t,e)}}function Ev(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(n.uniform4f(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Ct(t,e))return;n.uniform4fv(this.addr,e),Rt(t,e)}}function Cv(n,e){let t=this.cache,i=e.elements;if(i===void 0){if(Ct(t,e))return;n.uniformMatrix2fv(this.addr,!1,e),Rt(t,e)}else{if(Ct(t,i))return;uf.set(i),n.uniformMatrix2fv(this.addr,!1,uf),Rt(t,i)}}function Rv(n,e){let t=this.cache,i=e.elements;if(i===void 0){if(Ct(t,e))return;n.uniformMatrix3fv(this.addr,!1,e),Rt(t,e)}else{if(Ct(t,i))return;hf.set(i),n.uniformMatrix3fv(this.addr,!1,hf),Rt(t,i)}}function Pv(n,e){let t=this.cache,i=e.elements;if(i===void 0){if(Ct(t,e))return;n.uniformMatrix4fv(this.addr,!1,e),Rt(t,e)}else{if(Ct(t,i))return;cf.set(i),n.uniformMatrix4fv(this.addr,!1,cf),Rt(t,i)}}function Iv(n,e){let t=this.cache;t[0]!==e&&(n.uniform1i(this.addr,e),t[0]=e)}function Lv(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(n.uniform2i(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Ct(t,e))return;n.uniform2iv(this.addr,e),Rt(t,e)}}function Dv(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(n.uniform3i(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Ct(t,e))return;n.uniform3iv(this.addr,e),Rt(t,e)}}function Nv(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(n.uniform4i(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Ct(t,e))return;n.uniform4iv(this.addr,e),Rt(t,e)}}function kv(n,e){let t=this.cache;t[0]!==e&&(n.uniform1ui(this.addr,e),t[0]=e)}function Ov(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y)&&(n.uniform2ui(this.addr,e.x,e.y),t[0]=e.x,t[1]=e.y);else{if(Ct(t,e))return;n.uniform2uiv(this.addr,e),Rt(t,e)}}function Uv(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z)&&(n.uniform3ui(this.addr,e.x,e.y,e.z),t[0]=e.x,t[1]=e.y,t[2]=e.z);else{if(Ct(t,e))return;n.uniform3uiv(this.addr,e),Rt(t,e)}}function Fv(n,e){let t=this.cache;if(e.x!==void 0)(t[0]!==e.x||t[1]!==e.y||t[2]!==e.z||t[3]!==e.w)&&(n.uniform4ui(this.addr,e.x,e.y,e.z,e.w),t[0]=e.x,t[1]=e.y,t[2]=e.z,t[3]=e.w);else{if(Ct(t,e))return;n.uniform4uiv(this.addr,e),Rt(t,e)}}function rl(n){return n.version===0&&(n.compareFunction=Fc,n.needsUpdate=!0),n}function zv(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s);let r;this.type===n.SAMPLER_2D_SHADOW?r=rl(Rf):r=Cf,t.setTexture2D(e||r,s)}function Bv(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s),t.setTexture3D(e||Lf,s)}function Vv(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s);let r;this.type===n.SAMPLER_CUBE_SHADOW?r=rl(Pf):r=Df,t.setTextureCube(e||r,s)}function Gv(n,e,t){let i=this.cache,s=t.allocateTextureUnit();i[0]!==s&&(n.uniform1i(this.addr,s),i[0]=s),t.setTexture2DArray(e||If,s)}function Hv(n){switch(n){case 5126:return Mv;case 35664:return Av;case 35665:return Tv;case 35666:return Ev;case 35674:return Cv;case 35675:return Rv;case 35676:return Pv;case 5124:case 35670:return Iv;case 35667:case 35671:return Lv;case 35668:case 35672:return Dv;case 35669:case 35673:return Nv;case 5125:return kv;case 36294:return Ov;case 36295:return Uv;case 36296:return Fv;case 35678:case 36198:case 36298:case 36306:case 35682:return zv;case 35679:case 36299:case 36307:return Bv;case 35680:case 36300:case 36308:case 36293:return Vv;case 36289:case 36303:case 36311:case 36292:return Gv}}function Wv(n,e){n.uniform1fv(this.addr,e)}function $v(n,e){let t=Xs(e,this.size,2);n.uniform2fv(this.addr,t)}function qv(n,e){let t=Xs(e,this.size,3);n.uniform3fv(this.addr,t)}function Xv(n,e){let t=Xs(e,this.size,4);n.uniform4fv(this.addr,t)}function Yv(n,e){let t=Xs(e,this.size,4);n.uniformMatrix2fv(this.addr,!1,t)}function Zv(n,e){let t=Xs(e,this.size,9);n.uniformMatrix3fv(this.addr,!1,t)}function jv(n,e){let t=Xs(e,this.size,16);n.uniformMatrix4fv(this.addr,!1,t)}function Kv(n,e){n.uniform1iv(this.addr,e)}function Jv(n,e){n.uniform2iv(this.addr,e)}function Qv(n,e){n.uniform3iv(this.addr,e)}function ex(n,e){n.uniform4iv(this.addr,e)}function tx(n,e){n.uniform1uiv(this.addr,e)}function nx(n,e){n.uniform2uiv(this.addr,e)}function ix(n,e){n.uniform3uiv(this.addr,e)}function sx(n,e){n.uniform4uiv(this.addr,e)}function rx(n,e,t){let i=this.cache,s=e.length,r=sl(t,s);Ct(i,r)||(n.uniform1iv(this.addr,r),Rt(i,r));let o;this.type===n.SAMPLER_2D_SHADOW?o=rl(Rf):o=Cf;for(let a=0;a!==s;++a)t.setTexture2D(e[a]||o,r[a])}function ox(n,e,t){let i=this.cache,s=e.length,r=sl(t,s);Ct(i,r)||(n.uniform1iv(this.addr,r),Rt(i,r));for(let o=0;o!==s;++o)t.setTexture3D(e[o]||Lf,r[o])}function ax(n,e,t){let i=this.cache,s=e.length,r=sl(t,s);Ct(i,r)||(n.uniform1iv(this.addr,r),Rt(i,r));let o;this.type===n.SAMPLER_CUBE_SHADOW?o=rl(Pf):o=Df;for(let a=0;a!==s;++a)t.setTextureCube(e[a]||o,r[a])}function lx(n,e,t){let i=this.cache,s=e.length,r=sl(t,s);Ct(i,r)||(n.uniform1iv(this.addr,r),Rt(i,r));for(let o=0;o!==s;++o)t.setTexture2DArray(e[o]||If,r[o])}function cx(n){switch(n){case 5126:return Wv;case 35664:return $v;case 35665:return qv;case 35666:return Xv;case 35674:return Yv;case 35675:return Zv;case 35676:return jv;case 5124:case 35670:return Kv;case 35667:case 35671:return Jv;case 35668:case 35672:return Qv;case 35669:case 35673:return ex;case 5125:return tx;case 36294:return nx;case 36295:return ix;case 36296:return sx;case 35678:case 36198:case 36298:case 36306:case 35682:return rx;case 35679:case 36299:case 36307:return ox;case 35680:case 36300:case 36308:case 36293:return ax;case 36289:case 36303:case 36311:case 36292:return lx}}var jc=class{constructor(e,t,i){this.id=e,this.addr=i,this.cache=[],this.type=t.type,this.setValue=Hv(t.type)}},Kc=class{constructor(e,t,i){this.id=e,this.addr=i,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=cx(t.type)}},Jc=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,i){let s=this.seq;for(let r=0,o=s.length;r!==o;++r){let a=s[r];a.setValue(e,t[a.id],i)}}},Yc=/(\w+)(\])?(\[|\.)?/g;function df(n,e){n.seq.push(e),n.map[e.id]=e}function hx(n,e,t){let i=n.name,s=i.length;for(Yc.lastIndex=0;;){let r=Yc.exec(i),o=Yc.lastIndex,a=r[1],l=r[2]==="]",c=r[3];if(l&&(a=a|0),c===void 0||c==="["&&o+2===s){df(t,c===void 0?new jc(a,n,e):new Kc(a,n,e));break}else{let d=t.map[a];d===void 0&&(d=new Jc(a),df(t,d)),t=d}}}var qs=class{constructor(e,t){this.seq=[],this.map={};let i=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let o=0;o<i;++o){let a=e.getActiveUniform(t,o),l=e.getUniformLocation(t,a.name);hx(a,l,this)}let s=[],r=[];for(let o of this.seq)o.type===e.SAMPLER_2D_SHADOW||o.type===e.SAMPLER_CUBE_SHADOW||o.type===e.SAMPLER_2D_ARRAY_SHADOW?s.push(o):r.push(o);s.length>0&&(this.seq=s.concat(r))}setValue(e,t,i,s){let r=this.map[t];r!==void 0&&r.setValue(e,i,s)}setOptional(e,t,i){let s=t[i];s!==void 0&&this.setValue(e,i,s)}static upload(e,t,i,s){for(let r=0,o=t.length;r!==o;++r){let a=t[r],l=i[a.id];l.needsUpdate!==!1&&a.setValue(e,l.value,s)}}static seqWithValue(e,t){let i=[];for(let s=0,r=e.length;s!==r;++s){let o=e[s];o.id in t&&i.push(o)}return i}};function ff(n,e,t){let i=n.createShader(e);return n.shaderSource(i,t),n.compileShader(i),i}var ux=37297,dx=0;function fx(n,e){let t=n.split(`
`),i=[],s=Math.max(e-6,0),r=Math.min(e+6,t.length);for(let o=s;o<r;o++){let a=o+1;i.push(`${a===e?">":" "} ${a}: ${t[o]}`)}return i.join(`
`)}var pf=new Ue;function px(n){Ke._getMatrix(pf,Ke.workingColorSpace,n);let e=`mat3( ${pf.elements.map(t=>t.toFixed(4))} )`;switch(Ke.getTransfer(n)){case pr:return[e,"LinearTransferOETF"];case st:return[e,"sRGBTransferOETF"];default:return Le("WebGLProgram: Unsupported color space: ",n),[e,"LinearTransferOETF"]}}function mf(n,e,t){let i=n.getShaderParameter(e,n.COMPILE_STATUS),r=(n.getShaderInfoLog(e)||"").trim();if(i&&r==="")return"";let o=/ERROR: 0:(\d+)/.exec(r);if(o){let a=parseInt(o[1]);return t.toUpperCase()+`

`+r+`

`+fx(n.getShaderSource(e),a)}else return r}function mx(n,e){let t=px(e);return[`vec4 ${n}( vec4 value ) {`,`	return ${t[1]}( vec4( ${t[0]} * value.rgb, value.a ) );`,"}"].join(`
`)}var gx={[yc]:"Linear",[bc]:"Reinhard",[Sc]:"Cineon",[wc]:"ACESFilmic",[Ac]:"AgX",[Tc]:"Neutral",[Mc]:"Custom"};function _x(n,e){let t=gx[e];return t===void 0?(Le("WebGLProgram: Unsupported toneMapping:",e),"vec3 "+n+"( vec3 color ) { return LinearToneMapping( color ); }"):"vec3 "+n+"( vec3 color ) { return "+t+"ToneMapping( color ); }"}var tl=new O;function vx(){Ke.getLuminanceCoefficients(tl);let n=tl.x.toFixed(4),e=tl.y.toFixed(4),t=tl.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${n}, ${e}, ${t} );`,"	return dot( weights, rgb );","}"].join(`
`)}function xx(n){return[n.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",n.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(Ur).join(`
`)}function yx(n){let e=[];for(let t in n){let i=n[t];i!==!1&&e.push("#define "+t+" "+i)}return e.join(`
`)}function bx(n,e){let t={},i=n.getProgramParameter(e,n.ACTIVE_ATTRIBUTES);for(let s=0;s<i;s++){let r=n.getActiveAttrib(e,s),o=r.name,a=1;r.type===n.FLOAT_MAT2&&(a=2),r.type===n.FLOAT_MAT3&&(a=3),r.type===n.FLOAT_MAT4&&(a=4),t[o]={type:r.type,location:n.getAttribLocation(e,o),locationSize:a}}return t}function Ur(n){return n!==""}function gf(n,e){let t=e.numSpotLightShadows+e.numSpotLightMaps-e.numSpotLightShadowsWithMaps;return n.replace(/NUM_SUN_LIGHTS/g,e.numSunLights).replace(/NUM_DIR_LIGHTS/g,e.numDirLights).replace(/NUM_SPOT_LIGHTS/g,e.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,e.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,t).replace(/NUM_RECT_AREA_LIGHTS/g,e.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,e.numPointLights).replace(/NUM_HEMI_LIGHTS/g,e.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,e.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,e.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,e.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,e.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,e.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,e.numLightProbeGrids)}function _f(n,e){return n.replace(/NUM_CLIPPING_PLANES/g,e.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,e.numClippingPlanes-e.numClipIntersection)}var Sx=/^[ \t]*#include +<([\w\d./]+)>/gm;function Qc(n){return n.replace(Sx,wx)}function wx(n,e){let t=qe[e];if(t===void 0)throw new Error("THREE.WebGLProgram: Can not resolve #include <"+e+">");return Qc(t)}var Mx=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function vf(n){return n.replace(Mx,Ax)}function Ax(n,e,t,i){let s="";for(let r=parseInt(e);r<parseInt(t);r++)s+=i.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function xf(n){let e=`precision ${n.precision} float;
	precision ${n.precision} int;
	precision ${n.precision} sampler2D;
	precision ${n.precision} samplerCube;
	precision ${n.precision} sampler3D;
	precision ${n.precision} sampler2DArray;
	precision ${n.precision} sampler2DShadow;
	precision ${n.precision} samplerCubeShadow;
	precision ${n.precision} sampler2DArrayShadow;
	precision ${n.precision} isampler2D;
	precision ${n.precision} isampler3D;
	precision ${n.precision} isamplerCube;
	precision ${n.precision} isampler2DArray;
	precision ${n.precision} usampler2D;
	precision ${n.precision} usampler3D;
	precision ${n.precision} usamplerCube;
	precision ${n.precision} usampler2DArray;
	`;return n.precision==="highp"?e+=`
#define HIGH_PRECISION`:n.precision==="mediump"?e+=`
#define MEDIUM_PRECISION`:n.precision==="lowp"&&(e+=`
#define LOW_PRECISION`),e}var Tx={[Cr]:"SHADOWMAP_TYPE_PCF",[Vs]:"SHADOWMAP_TYPE_VSM"};function Ex(n){return Tx[n.shadowMapType]||"SHADOWMAP_TYPE_BASIC"}var Cx={[Hs]:"ENVMAP_MODE_REFRACTION"};function Rx(n){return n.envMap===!1?"ENVMAP_MODE_REFLECTION":Cx[n.envMapMode]||"ENVMAP_MODE_REFLECTION"}var Px={[xc]:"ENVMAP_BLENDING_MULTIPLY",[Nd]:"ENVMAP_BLENDING_MIX",[kd]:"ENVMAP_BLENDING_ADD"};function Ix(n){return n.envMap===!1?"ENVMAP_BLENDING_NONE":Px[n.combine]||"ENVMAP_BLENDING_NONE"}function Lx(n,e,t,i){let s=n.getContext(),r=t.defines,o=t.vertexShader,a=t.fragmentShader,l=Ex(t),c=t.envMapPMREM===!0?"ENVMAP_TYPE_PMREM":"ENVMAP_TYPE_CUBE",h=Rx(t),d=Ix(t),u=xx(t),f=yx(r),g=s.createProgram(),w,p,m=t.glslVersion?"#version "+t.glslVersion+`
`:"";t.isRawShaderMaterial?(w=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(Ur).join(`
`),w.length>0&&(w+=`
`),p=["#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f].filter(Ur).join(`
`),p.length>0&&(p+=`
`)):(w=[xf(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",t.batching?"#define USE_BATCHING":"",t.batchingColor?"#define USE_BATCHING_COLOR":"",t.instancing?"#define USE_INSTANCING":"",t.instancingColor?"#define USE_INSTANCING_COLOR":"",t.instancingMorph?"#define USE_INSTANCING_MORPH":"",t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.map?"#define USE_MAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+h:"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.displacementMap?"#define USE_DISPLACEMENTMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.mapUv?"#define MAP_UV "+t.mapUv:"",t.alphaMapUv?"#define ALPHAMAP_UV "+t.alphaMapUv:"",t.lightMapUv?"#define LIGHTMAP_UV "+t.lightMapUv:"",t.aoMapUv?"#define AOMAP_UV "+t.aoMapUv:"",t.emissiveMapUv?"#define EMISSIVEMAP_UV "+t.emissiveMapUv:"",t.bumpMapUv?"#define BUMPMAP_UV "+t.bumpMapUv:"",t.normalMapUv?"#define NORMALMAP_UV "+t.normalMapUv:"",t.displacementMapUv?"#define DISPLACEMENTMAP_UV "+t.displacementMapUv:"",t.metalnessMapUv?"#define METALNESSMAP_UV "+t.metalnessMapUv:"",t.roughnessMapUv?"#define ROUGHNESSMAP_UV "+t.roughnessMapUv:"",t.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+t.anisotropyMapUv:"",t.clearcoatMapUv?"#define CLEARCOATMAP_UV "+t.clearcoatMapUv:"",t.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+t.clearcoatNormalMapUv:"",t.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+t.clearcoatRoughnessMapUv:"",t.diffuseRoughnessMapUv?"#define DIFFUSE_ROUGHNESSMAP_UV "+t.diffuseRoughnessMapUv:"",t.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+t.iridescenceMapUv:"",t.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+t.iridescenceThicknessMapUv:"",t.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+t.sheenColorMapUv:"",t.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+t.sheenRoughnessMapUv:"",t.specularMapUv?"#define SPECULARMAP_UV "+t.specularMapUv:"",t.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+t.specularColorMapUv:"",t.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+t.specularIntensityMapUv:"",t.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+t.transmissionMapUv:"",t.thicknessMapUv?"#define THICKNESSMAP_UV "+t.thicknessMapUv:"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexNormals?"#define HAS_NORMAL":"",t.vertexColors?"#define USE_COLOR":"",t.vertexAlphas?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.flatShading?"#define FLAT_SHADED":"",t.skinning?"#define USE_SKINNING":"",t.morphTargets?"#define USE_MORPHTARGETS":"",t.morphNormals&&t.flatShading===!1?"#define USE_MORPHNORMALS":"",t.morphColors?"#define USE_MORPHCOLORS":"",t.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+t.morphTextureStride:"",t.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+t.morphTargetsCount:"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.sizeAttenuation?"#define USE_SIZEATTENUATION":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(Ur).join(`
`),p=[xf(t),"#define SHADER_TYPE "+t.shaderType,"#define SHADER_NAME "+t.shaderName,f,t.useFog&&t.fog?"#define USE_FOG":"",t.useFog&&t.fogExp2?"#define FOG_EXP2":"",t.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",t.map?"#define USE_MAP":"",t.matcap?"#define USE_MATCAP":"",t.envMap?"#define USE_ENVMAP":"",t.envMap?"#define "+c:"",t.envMap?"#define "+h:"",t.envMap?"#define "+d:"",t.envMapPMREM?"#define ENVMAP_MAX_LOD "+t.envMapMaxLod+".0":"",t.envMapPMREM?"#define ENVMAP_SIZE "+t.envMapSize+".0":"",t.lightMap?"#define USE_LIGHTMAP":"",t.aoMap?"#define USE_AOMAP":"",t.bumpMap?"#define USE_BUMPMAP":"",t.normalMap?"#define USE_NORMALMAP":"",t.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",t.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",t.packedNormalMap?"#define USE_PACKED_NORMALMAP":"",t.emissiveMap?"#define USE_EMISSIVEMAP":"",t.anisotropy?"#define USE_ANISOTROPY":"",t.anisotropyMap?"#define USE_ANISOTROPYMAP":"",t.clearcoat?"#define USE_CLEARCOAT":"",t.clearcoatMap?"#define USE_CLEARCOATMAP":"",t.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",t.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",t.diffuseRoughness?"#define USE_DIFFUSE_ROUGHNESS":"",t.diffuseRoughnessMap?"#define USE_DIFFUSE_ROUGHNESSMAP":"",t.dispersion?"#define USE_DISPERSION":"",t.retroreflection?"#define USE_RETROREFLECTION":"",t.iridescence?"#define USE_IRIDESCENCE":"",t.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",t.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",t.specularMap?"#define USE_SPECULARMAP":"",t.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",t.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",t.roughnessMap?"#define USE_ROUGHNESSMAP":"",t.metalnessMap?"#define USE_METALNESSMAP":"",t.alphaMap?"#define USE_ALPHAMAP":"",t.alphaTest?"#define USE_ALPHATEST":"",t.alphaHash?"#define USE_ALPHAHASH":"",t.sheen?"#define USE_SHEEN":"",t.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",t.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",t.transmission?"#define USE_TRANSMISSION":"",t.transmissionMap?"#define USE_TRANSMISSIONMAP":"",t.thicknessMap?"#define USE_THICKNESSMAP":"",t.vertexTangents&&t.flatShading===!1?"#define USE_TANGENT":"",t.vertexColors||t.instancingColor?"#define USE_COLOR":"",t.vertexAlphas||t.batchingColor?"#define USE_COLOR_ALPHA":"",t.vertexUv1s?"#define USE_UV1":"",t.vertexUv2s?"#define USE_UV2":"",t.vertexUv3s?"#define USE_UV3":"",t.pointsUvs?"#define USE_POINTS_UV":"",t.gradientMap?"#define USE_GRADIENTMAP":"",t.flatShading?"#define FLAT_SHADED":"",t.doubleSided?"#define DOUBLE_SIDED":"",t.flipSided?"#define FLIP_SIDED":"",t.shadowMapEnabled?"#define USE_SHADOWMAP":"",t.shadowMapEnabled?"#define "+l:"",t.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",t.numLightProbes>0?"#define USE_LIGHT_PROBES":"",t.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",t.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",t.logarithmicDepthBuffer?"#define USE_LOGARITHMIC_DEPTH_BUFFER":"",t.reversedDepthBuffer?"#define USE_REVERSED_DEPTH_BUFFER":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",t.toneMapping!==Gn?"#define TONE_MAPPING":"",t.toneMapping!==Gn?qe.tonemapping_pars_fragment:"",t.toneMapping!==Gn?_x("toneMapping",t.toneMapping):"",t.dithering?"#define DITHERING":"",t.opaque?"#define OPAQUE":"",qe.colorspace_pars_fragment,mx("linearToOutputTexel",t.outputColorSpace),vx(),t.useDepthPacking?"#define DEPTH_PACKING "+t.depthPacking:"",`
`].filter(Ur).join(`
`)),o=Qc(o),o=gf(o,t),o=_f(o,t),a=Qc(a),a=gf(a,t),a=_f(a,t),o=vf(o),a=vf(a),t.isRawShaderMaterial!==!0&&(m=`#version 300 es
`,w=[u,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+w,p=["#define varying in",t.glslVersion===Hn?"":"layout(location = 0) out highp vec4 pc_fragColor;",t.glslVersion===Hn?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+p);let S=m+w+o,R=m+p+a,T=ff(s,s.VERTEX_SHADER,S),M=ff(s,s.FRAGMENT_SHADER,R);s.attachShader(g,T),s.attachShader(g,M),t.index0AttributeName!==void 0?s.bindAttribLocation(g,0,t.index0AttributeName):t.hasPositionAttribute===!0&&s.bindAttribLocation(g,0,"position"),s.linkProgram(g);function E(N){if(n.debug.checkShaderErrors){let U=s.getProgramInfoLog(g)||"",V=s.getShaderInfoLog(T)||"",q=s.getShaderInfoLog(M)||"",I=U.trim(),H=V.trim(),Z=q.trim(),W=!0,ie=!0;if(s.getProgramParameter(g,s.LINK_STATUS)===!1)if(W=!1,typeof n.debug.onShaderError=="function")n.debug.onShaderError(s,g,T,M);else{let Y=mf(s,T,"vertex"),te=mf(s,M,"fragment");Oe("WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(g,s.VALIDATE_STATUS)+`

Material Name: `+N.name+`
Material Type: `+N.type+`

Program Info Log: `+I+`
`+Y+`
`+te)}else I!==""?Le("WebGLProgram: Program Info Log:",I):(H===""||Z==="")&&(ie=!1);ie&&(N.diagnostics={runnable:W,programLog:I,vertexShader:{log:H,prefix:w},fragmentShader:{log:Z,prefix:p}})}s.deleteShader(T),s.deleteShader(M),_=new qs(s,g),A=bx(s,g)}let _;this.getUniforms=function(){return _===void 0&&E(this),_};let A;this.getAttributes=function(){return A===void 0&&E(this),A};let F=t.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return F===!1&&(F=s.getProgramParameter(g,ux)),F},this.destroy=function(){i.releaseStatesOfProgram(this),s.deleteProgram(g),this.program=void 0},this.type=t.shaderType,this.name=t.shaderName,this.id=dx++,this.cacheKey=e,this.usedTimes=1,this.program=g,this.vertexShader=T,this.fragmentShader=M,this}var Dx=0,eh=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,i){let s=this._getShaderCacheForMaterial(e);return s.has(t)===!1&&(s.add(t),t.usedTimes++),s.has(i)===!1&&(s.add(i),i.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let i of t)i.usedTimes--,i.usedTimes===0&&this.shaderCache.delete(i.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,i=t.get(e);return i===void 0&&(i=new Set,t.set(e,i)),i}_getShaderStage(e){let t=this.shaderCache,i=t.get(e);return i===void 0&&(i=new th(e),t.set(e,i)),i}},th=class{constructor(e){this.id=Dx++,this.code=e,this.usedTimes=0}};function Nx(n){return n===Di||n===Nr||n===kr}function kx(n,e,t,i,s,r){let o=new vr,a=new eh,l=new Set,c=[],h=new Map,d=i.logarithmicDepthBuffer,u={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distance",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function f(_){return l.add(_),_===0?"uv":`uv${_}`}function g(_,A,F,N,U,V){let q=N.fog,I=U.geometry,H=_.isMeshStandardMaterial||_.isMeshLambertMaterial||_.isMeshPhongMaterial?N.environment:null,Z=_.isMeshStandardMaterial||_.isMeshLambertMaterial&&!_.envMap||_.isMeshPhongMaterial&&!_.envMap,W=e.get(_.envMap||H,Z),ie=u[_.type],Y=i.precision;_.precision!==null&&(Y=i.getMaxPrecision(_.precision),Y!==_.precision&&Le("WebGLProgram.getParameters:",_.precision,"not supported, using",Y,"instead."));let te=I.morphAttributes.position||I.morphAttributes.normal||I.morphAttributes.color,ne=te!==void 0?te.length:0,Ae=0;I.morphAttributes.position!==void 0&&(Ae=1),I.morphAttributes.normal!==void 0&&(Ae=2),I.morphAttributes.color!==void 0&&(Ae=3);let ze,J,_e,Se;if(ie){let me=$n[ie];ze=me.vertexShader,J=me.fragmentShader}else{ze=_.vertexShader,J=_.fragmentShader;let me=a.getVertexShaderStage(_),ot=a.getFragmentShaderStage(_);a.update(_,me,ot),_e=me.id,Se=ot.id}let Re=n.getRenderTarget(),ve=n.state.buffers.depth.getReversed(),Ge=U.isInstancedMesh===!0,bt=U.isBatchedMesh===!0,Ne=!!_.map,rt=!!_.matcap,ct=!!W,Ye=ct&&W.isPMREMTexture===!0,Ot=!!_.aoMap,At=!!_.lightMap,Jt=!!_.bumpMap&&_.wireframe===!1,gt=!!_.normalMap,kn=!!_.displacementMap,It=!!_.emissiveMap,fn=!!_.metalnessMap,pn=!!_.roughnessMap,mn=_.anisotropy>0,k=_.clearcoat>0,gn=_.diffuseRoughness>0,pt=_.dispersion>0,mt=_.retroreflectivity>0,pe=_.iridescence>0,Tt=_.sheen>0,Pe=_.transmission>0,Fe=mn&&!!_.anisotropyMap,C=k&&!!_.clearcoatMap,y=k&&!!_.clearcoatNormalMap,B=k&&!!_.clearcoatRoughnessMap,se=gn&&!!_.diffuseRoughnessMap,ee=pe&&!!_.iridescenceMap,ae=pe&&!!_.iridescenceThicknessMap,de=Tt&&!!_.sheenColorMap,j=Tt&&!!_.sheenRoughnessMap,K=!!_.specularMap,ce=!!_.specularColorMap,P=!!_.specularIntensityMap,Q=Pe&&!!_.transmissionMap,X=Pe&&!!_.thicknessMap,he=!!_.gradientMap,oe=!!_.alphaMap,le=_.alphaTest>0,Ee=!!_.alphaHash,$e=!!_.extensions,re=Gn;_.toneMapped&&(Re===null||Re.isXRRenderTarget===!0)&&(re=n.toneMapping);let Ce=Ye?W.isCompressedCubeTexture?W.image[0].mipmaps:W.mipmaps:null,We={shaderID:ie,shaderType:_.type,shaderName:_.name,vertexShader:ze,fragmentShader:J,defines:_.defines,customVertexShaderID:_e,customFragmentShaderID:Se,isRawShaderMaterial:_.isRawShaderMaterial===!0,glslVersion:_.glslVersion,precision:Y,batching:bt,batchingColor:bt&&U._colorsTexture!==null,instancing:Ge,instancingColor:Ge&&U.instanceColor!==null,instancingMorph:Ge&&U.morphTexture!==null,outputColorSpace:Re===null?n.outputColorSpace:Re.isXRRenderTarget===!0?Re.texture.colorSpace:Ke.workingColorSpace,alphaToCoverage:!!_.alphaToCoverage,map:Ne,matcap:rt,envMap:ct,envMapMode:ct&&W.mapping,envMapPMREM:Ye,envMapMaxLod:Ye?Ce.length-1:null,envMapSize:Ye?Ce[0].width:null,aoMap:Ot,lightMap:At,bumpMap:Jt,normalMap:gt,displacementMap:kn,emissiveMap:It,normalMapObjectSpace:gt&&_.normalMapType===Fd,normalMapTangentSpace:gt&&_.normalMapType===kc,packedNormalMap:gt&&_.normalMapType===kc&&Nx(_.normalMap.format),metalnessMap:fn,roughnessMap:pn,anisotropy:mn,anisotropyMap:Fe,clearcoat:k,clearcoatMap:C,clearcoatNormalMap:y,clearcoatRoughnessMap:B,diffuseRoughness:gn,diffuseRoughnessMap:se,dispersion:pt,retroreflection:mt,iridescence:pe,iridescenceMap:ee,iridescenceThicknessMap:ae,sheen:Tt,sheenColorMap:de,sheenRoughnessMap:j,specularMap:K,specularColorMap:ce,specularIntensityMap:P,transmission:Pe,transmissionMap:Q,thicknessMap:X,gradientMap:he,opaque:_.transparent===!1&&_.blending===Gs&&_.alphaToCoverage===!1,alphaMap:oe,alphaTest:le,alphaHash:Ee,combine:_.combine,mapUv:Ne&&f(_.map.channel),aoMapUv:Ot&&f(_.aoMap.channel),lightMapUv:At&&f(_.lightMap.channel),bumpMapUv:Jt&&f(_.bumpMap.channel),normalMapUv:gt&&f(_.normalMap.channel),displacementMapUv:kn&&f(_.displacementMap.channel),emissiveMapUv:It&&f(_.emissiveMap.channel),metalnessMapUv:fn&&f(_.metalnessMap.channel),roughnessMapUv:pn&&f(_.roughnessMap.channel),anisotropyMapUv:Fe&&f(_.anisotropyMap.channel),clearcoatMapUv:C&&f(_.clearcoatMap.channel),clearcoatNormalMapUv:y&&f(_.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:B&&f(_.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:se&&f(_.diffuseRoughnessMap.channel),iridescenceMapUv:ee&&f(_.iridescenceMap.channel),iridescenceThicknessMapUv:ae&&f(_.iridescenceThicknessMap.channel),sheenColorMapUv:de&&f(_.sheenColorMap.channel),sheenRoughnessMapUv:j&&f(_.sheenRoughnessMap.channel),specularMapUv:K&&f(_.specularMap.channel),specularColorMapUv:ce&&f(_.specularColorMap.channel),specularIntensityMapUv:P&&f(_.specularIntensityMap.channel),transmissionMapUv:Q&&f(_.transmissionMap.channel),thicknessMapUv:X&&f(_.thicknessMap.channel),alphaMapUv:oe&&f(_.alphaMap.channel),vertexTangents:!!I.attributes.tangent&&(gt||mn),vertexNormals:!!I.attributes.normal,vertexColors:_.vertexColors,vertexAlphas:_.vertexColors===!0&&!!I.attributes.color&&I.attributes.color.itemSize===4,pointsUvs:U.isPoints===!0&&!!I.attributes.uv&&(Ne||oe),fog:!!q,useFog:_.fog===!0,fogExp2:!!q&&q.isFogExp2,flatShading:_.wireframe===!1&&(_.flatShading===!0||I.attributes.normal===void 0&&gt===!1&&(_.isMeshLambertMaterial||_.isMeshPhongMaterial||_.isMeshStandardMaterial||_.isMeshPhysicalMaterial)),sizeAttenuation:_.sizeAttenuation===!0,logarithmicDepthBuffer:d,reversedDepthBuffer:ve,skinning:U.isSkinnedMesh===!0,hasPositionAttribute:I.attributes.position!==void 0,morphTargets:I.morphAttributes.position!==void 0,morphNormals:I.morphAttributes.normal!==void 0,morphColors:I.morphAttributes.color!==void 0,morphTargetsCount:ne,morphTextureStride:Ae,numSunLights:A.sun.length,numDirLights:A.directional.length,numPointLights:A.point.length,numSpotLights:A.spot.length,numSpotLightMaps:A.spotLightMap.length,numRectAreaLights:A.rectArea.length,numHemiLights:A.hemi.length,numSunLightShadows:A.sunShadowMap.length,numDirLightShadows:A.directionalShadowMap.length,numPointLightShadows:A.pointShadowMap.length,numSpotLightShadows:A.spotShadowMap.length,numSpotLightShadowsWithMaps:A.numSpotLightShadowsWithMaps,numLightProbes:A.numLightProbes,numLightProbeGrids:V.filter(me=>me.texture!==null).length,numClippingPlanes:r.numPlanes,numClipIntersection:r.numIntersection,dithering:_.dithering,shadowMapEnabled:n.shadowMap.enabled&&F.length>0,shadowMapType:n.shadowMap.type,toneMapping:re,decodeVideoTexture:Ne&&_.map.isVideoTexture===!0&&Ke.getTransfer(_.map.colorSpace)===st,decodeVideoTextureEmissive:It&&_.emissiveMap.isVideoTexture===!0&&Ke.getTransfer(_.emissiveMap.colorSpace)===st,premultipliedAlpha:_.premultipliedAlpha,doubleSided:_.side===dn,flipSided:_.side===jt,useDepthPacking:_.depthPacking>=0,depthPacking:_.depthPacking||0,index0AttributeName:_.index0AttributeName,extensionClipCullDistance:$e&&_.extensions.clipCullDistance===!0&&t.has("WEBGL_clip_cull_distance"),extensionMultiDraw:($e&&_.extensions.multiDraw===!0||bt)&&t.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:t.has("KHR_parallel_shader_compile"),customProgramCacheKey:_.customProgramCacheKey()};return We.vertexUv1s=l.has(1),We.vertexUv2s=l.has(2),We.vertexUv3s=l.has(3),l.clear(),We}function w(_){let A=[];if(_.shaderID?A.push(_.shaderID):(A.push(_.customVertexShaderID),A.push(_.customFragmentShaderID)),_.defines!==void 0)for(let F in _.defines)A.push(F),A.push(_.defines[F]);return _.isRawShaderMaterial===!1&&(p(A,_),m(A,_),A.push(n.outputColorSpace)),A.push(_.customProgramCacheKey),A.join()}function p(_,A){_.push(A.precision),_.push(A.outputColorSpace),_.push(A.envMapMode),_.push(A.envMapPMREM),_.push(A.envMapMaxLod),_.push(A.envMapSize),_.push(A.mapUv),_.push(A.alphaMapUv),_.push(A.lightMapUv),_.push(A.aoMapUv),_.push(A.bumpMapUv),_.push(A.normalMapUv),_.push(A.displacementMapUv),_.push(A.emissiveMapUv),_.push(A.metalnessMapUv),_.push(A.roughnessMapUv),_.push(A.anisotropyMapUv),_.push(A.clearcoatMapUv),_.push(A.clearcoatNormalMapUv),_.push(A.clearcoatRoughnessMapUv),_.push(A.diffuseRoughnessMapUv),_.push(A.iridescenceMapUv),_.push(A.iridescenceThicknessMapUv),_.push(A.sheenColorMapUv),_.push(A.sheenRoughnessMapUv),_.push(A.specularMapUv),_.push(A.specularColorMapUv),_.push(A.specularIntensityMapUv),_.push(A.transmissionMapUv),_.push(A.thicknessMapUv),_.push(A.combine),_.push(A.fogExp2),_.push(A.sizeAttenuation),_.push(A.morphTargetsCount),_.push(A.numSunLights),_.push(A.numDirLights),_.push(A.numPointLights),_.push(A.numSpotLights),_.push(A.numSpotLightMaps),_.push(A.numHemiLights),_.push(A.numRectAreaLights),_.push(A.numSunLightShadows),_.push(A.numDirLightShadows),_.push(A.numPointLightShadows),_.push(A.numSpotLightShadows),_.push(A.numSpotLightShadowsWithMaps),_.push(A.numLightProbes),_.push(A.numLightProbeGrids),_.push(A.shadowMapType),_.push(A.toneMapping),_.push(A.numClippingPlanes),_.push(A.numClipIntersection),_.push(A.depthPacking)}function m(_,A){o.disableAll(),A.instancing&&o.enable(0),A.instancingColor&&o.enable(1),A.instancingMorph&&o.enable(2),A.matcap&&o.enable(3),A.envMap&&o.enable(4),A.normalMapObjectSpace&&o.enable(5),A.normalMapTangentSpace&&o.enable(6),A.clearcoat&&o.enable(7),A.iridescence&&o.enable(8),A.alphaTest&&o.enable(9),A.vertexColors&&o.enable(10),A.vertexAlphas&&o.enable(11),A.vertexUv1s&&o.enable(12),A.vertexUv2s&&o.enable(13),A.vertexUv3s&&o.enable(14),A.vertexTangents&&o.enable(15),A.anisotropy&&o.enable(16),A.alphaHash&&o.enable(17),A.batching&&o.enable(18),A.dispersion&&o.enable(19),A.retroreflection&&o.enable(24),A.diffuseRoughness&&o.enable(25),A.batchingColor&&o.enable(20),A.gradientMap&&o.enable(21),A.packedNormalMap&&o.enable(22),A.vertexNormals&&o.enable(23),_.push(o.mask),o.disableAll(),A.fog&&o.enable(0),A.useFog&&o.enable(1),A.flatShading&&o.enable(2),A.logarithmicDepthBuffer&&o.enable(3),A.reversedDepthBuffer&&o.enable(4),A.skinning&&o.enable(5),A.morphTargets&&o.enable(6),A.morphNormals&&o.enable(7),A.morphColors&&o.enable(8),A.premultipliedAlpha&&o.enable(9),A.shadowMapEnabled&&o.enable(10),A.doubleSided&&o.enable(11),A.flipSided&&o.enable(12),A.useDepthPacking&&o.enable(13),A.dithering&&o.enable(14),A.transmission&&o.enable(15),A.sheen&&o.enable(16),A.opaque&&o.enable(17),A.pointsUvs&&o.enable(18),A.decodeVideoTexture&&o.enable(19),A.decodeVideoTextureEmissive&&o.enable(20),A.alphaToCoverage&&o.enable(21),A.numLightProbeGrids>0&&o.enable(22),A.hasPositionAttribute&&o.enable(23),_.push(o.mask)}function S(_){let A=u[_.type],F;if(A){let N=$n[A];F=Qd.clone(N.uniforms)}else F=_.uniforms;return F}function R(_,A){let F=h.get(A);return F!==void 0?++F.usedTimes:(F=new Lx(n,A,_,s),c.push(F),h.set(A,F)),F}function T(_){if(--_.usedTimes===0){let A=c.indexOf(_);c[A]=c[c.length-1],c.pop(),h.delete(_.cacheKey),_.destroy()}}function M(_){a.remove(_)}function E(){a.dispose()}return{getParameters:g,getProgramCacheKey:w,getUniforms:S,acquireProgram:R,releaseProgram:T,releaseShaderCache:M,programs:c,dispose:E}}function Ox(){let n=new WeakMap;function e(o){return n.has(o)}function t(o){let a=n.get(o);return a===void 0&&(a={},n.set(o,a)),a}function i(o){n.delete(o)}function s(o,a,l){n.get(o)[a]=l}function r(){n=new WeakMap}return{has:e,get:t,remove:i,update:s,dispose:r}}function Ux(n,e){return n.groupOrder!==e.groupOrder?n.groupOrder-e.groupOrder:n.renderOrder!==e.renderOrder?n.renderOrder-e.renderOrder:n.material.id!==e.material.id?n.material.id-e.material.id:n.materialVariant!==e.materialVariant?n.materialVariant-e.materialVariant:n.z!==e.z?n.z-e.z:n.id-e.id}function yf(n,e){return n.groupOrder!==e.groupOrder?n.groupOrder-e.groupOrder:n.renderOrder!==e.renderOrder?n.renderOrder-e.renderOrder:n.z!==e.z?e.z-n.z:n.id-e.id}function bf(){let n=[],e=0,t=[],i=[],s=[];function r(){e=0,t.length=0,i.length=0,s.length=0}function o(u){let f=0;return u.isInstancedMesh&&(f+=2),u.isSkinnedMesh&&(f+=1),f}function a(u,f,g,w,p,m){let S=n[e];return S===void 0?(S={id:u.id,object:u,geometry:f,material:g,materialVariant:o(u),groupOrder:w,renderOrder:u.renderOrder,z:p,group:m},n[e]=S):(S.id=u.id,S.object=u,S.geometry=f,S.material=g,S.materialVariant=o(u),S.groupOrder=w,S.renderOrder=u.renderOrder,S.z=p,S.group=m),e++,S}function l(u,f,g,w,p,m,S){S.reversedDepth===!0&&(p=-p);let R=a(u,f,g,w,p,m);g.transmission>0?i.push(R):g.transparent===!0?s.push(R):t.push(R)}function c(u,f,g,w,p,m){let S=a(u,f,g,w,p,m);g.transmission>0?i.unshift(S):g.transparent===!0?s.unshift(S):t.unshift(S)}function h(u,f){t.length>1&&t.sort(u||Ux),i.length>1&&i.sort(f||yf),s.length>1&&s.sort(f||yf)}function d(){for(let u=e,f=n.length;u<f;u++){let g=n[u];if(g.id===null)break;g.id=null,g.object=null,g.geometry=null,g.material=null,g.group=null}}return{opaque:t,transmissive:i,transparent:s,init:r,push:l,unshift:c,finish:d,sort:h}}function Fx(){let n=new WeakMap;function e(i,s){let r=n.get(i),o;return r===void 0?(o=new bf,n.set(i,[o])):s>=r.length?(o=new bf,r.push(o)):o=r[s],o}function t(){n=new WeakMap}return{get:e,dispose:t}}function zx(){let n={};return{get:function(e){if(n[e.id]!==void 0)return n[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={direction:new O,color:new Ve};break;case"SpotLight":t={position:new O,direction:new O,color:new Ve,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":t={position:new O,color:new Ve,distance:0,decay:0};break;case"HemisphereLight":t={direction:new O,skyColor:new Ve,groundColor:new Ve};break;case"RectAreaLight":t={color:new Ve,position:new O,halfWidth:new O,halfHeight:new O};break}return n[e.id]=t,t}}}function Bx(){let n={};return{get:function(e){if(n[e.id]!==void 0)return n[e.id];let t;switch(e.type){case"SunLight":case"DirectionalLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new De};break;case"SpotLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new De};break;case"PointLight":t={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new De,shadowCameraNear:1,shadowCameraFar:1e3};break}return n[e.id]=t,t}}}var Vx=0;function Gx(n,e){return(e.castShadow?2:0)-(n.castShadow?2:0)+(e.map?1:0)-(n.map?1:0)}function Hx(n){let e=new zx,t=Bx(),i={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)i.probe.push(new O);let s=new O,r=new ut,o=new ut;function a(c){let h=0,d=0,u=0;for(let V=0;V<9;V++)i.probe[V].set(0,0,0);let f=0,g=0,w=0,p=0,m=0,S=0,R=0,T=0,M=0,E=0,_=0,A=0,F=0,N=0;c.sort(Gx);for(let V=0,q=c.length;V<q;V++){let I=c[V],H=I.color,Z=I.intensity,W=I.distance,ie=null;if(I.shadow&&I.shadow.map&&(I.shadow.map.texture.format===Di?ie=I.shadow.map.texture:ie=I.shadow.map.depthTexture||I.shadow.map.texture),I.isAmbientLight)h+=H.r*Z,d+=H.g*Z,u+=H.b*Z;else if(I.isLightProbe){for(let Y=0;Y<9;Y++)i.probe[Y].addScaledVector(I.sh.coefficients[Y],Z);N++}else if(I.isSunLight){let Y=e.get(I);if(Y.color.copy(I.color).multiplyScalar(I.intensity),I.castShadow){let te=I.shadow,ne=t.get(I);ne.shadowIntensity=te.intensity,ne.shadowBias=te.bias,ne.shadowNormalBias=te.normalBias,ne.shadowRadius=te.radius,ne.shadowMapSize.copy(te.mapSize).multiply(te.getFrameExtents()),i.sunShadow[g]=ne,i.sunShadowMap[g]=ie;let Ae=te.getViewportCount();for(let ze=0;ze<Ae;ze++)i.sunShadowMatrix[w+ze]=te.getMatrix(ze),i.sunShadowCascade[w+ze]=te._cascadeData[ze];w+=Ae,g++}i.sun[f]=Y,f++}else if(I.isDirectionalLight){let Y=e.get(I);if(Y.color.copy(I.color).multiplyScalar(I.intensity),I.castShadow){let te=I.shadow,ne=t.get(I);ne.shadowIntensity=te.intensity,ne.shadowBias=te.bias,ne.shadowNormalBias=te.normalBias,ne.shadowRadius=te.radius,ne.shadowMapSize=te.mapSize,i.directionalShadow[p]=ne,i.directionalShadowMap[p]=ie,i.directionalShadowMatrix[p]=I.shadow.matrix,M++}i.directional[p]=Y,p++}else if(I.isSpotLight){let Y=e.get(I);Y.position.setFromMatrixPosition(I.matrixWorld),Y.color.copy(H).multiplyScalar(Z),Y.distance=W,Y.coneCos=Math.cos(I.angle),Y.penumbraCos=Math.cos(I.angle*(1-I.penumbra)),Y.decay=I.decay,i.spot[S]=Y;let te=I.shadow;if(I.map&&(i.spotLightMap[A]=I.map,A++,te.updateMatrices(I),I.castShadow&&F++),i.spotLightMatrix[S]=te.matrix,I.castShadow){let ne=t.get(I);ne.shadowIntensity=te.intensity,ne.shadowBias=te.bias,ne.shadowNormalBias=te.normalBias,ne.shadowRadius=te.radius,ne.shadowMapSize=te.mapSize,i.spotShadow[S]=ne,i.spotShadowMap[S]=ie,_++}S++}else if(I.isRectAreaLight){let Y=e.get(I);Y.color.copy(H).multiplyScalar(Z),Y.halfWidth.set(I.width*.5,0,0),Y.halfHeight.set(0,I.height*.5,0),i.rectArea[R]=Y,R++}else if(I.isPointLight){let Y=e.get(I);if(Y.color.copy(I.color).multiplyScalar(I.intensity),Y.distance=I.distance,Y.decay=I.decay,I.castShadow){let te=I.shadow,ne=t.get(I);ne.shadowIntensity=te.intensity,ne.shadowBias=te.bias,ne.shadowNormalBias=te.normalBias,ne.shadowRadius=te.radius,ne.shadowMapSize=te.mapSize,ne.shadowCameraNear=te.camera.near,ne.shadowCameraFar=te.camera.far,i.pointShadow[m]=ne,i.pointShadowMap[m]=ie,i.pointShadowMatrix[m]=I.shadow.matrix,E++}i.point[m]=Y,m++}else if(I.isHemisphereLight){let Y=e.get(I);Y.skyColor.copy(I.color).multiplyScalar(Z),Y.groundColor.copy(I.groundColor).multiplyScalar(Z),i.hemi[T]=Y,T++}}R>0&&(n.has("OES_texture_float_linear")===!0?(i.rectAreaLTC1=ge.LTC_FLOAT_1,i.rectAreaLTC2=ge.LTC_FLOAT_2):(i.rectAreaLTC1=ge.LTC_HALF_1,i.rectAreaLTC2=ge.LTC_HALF_2)),i.ambient[0]=h,i.ambient[1]=d,i.ambient[2]=u;let U=i.hash;(U.sunLength!==f||U.directionalLength!==p||U.pointLength!==m||U.spotLength!==S||U.rectAreaLength!==R||U.hemiLength!==T||U.numSunShadows!==g||U.numDirectionalShadows!==M||U.numPointShadows!==E||U.numSpotShadows!==_||U.numSpotMaps!==A||U.numLightProbes!==N)&&(i.sun.length=f,i.directional.length=p,i.spot.length=S,i.rectArea.length=R,i.point.length=m,i.hemi.length=T,i.sunShadow.length=g,i.sunShadowMap.length=g,i.sunShadowMatrix.length=w,i.sunShadowCascade.length=w,i.directionalShadow.length=M,i.directionalShadowMap.length=M,i.directionalShadowMatrix.length=M,i.pointShadow.length=E,i.pointShadowMap.length=E,i.pointShadowMatrix.length=E,i.spotShadow.length=_,i.spotShadowMap.length=_,i.spotLightMatrix.length=_+A-F,i.spotLightMap.length=A,i.numSpotLightShadowsWithMaps=F,i.numLightProbes=N,U.sunLength=f,U.directionalLength=p,U.pointLength=m,U.spotLength=S,U.rectAreaLength=R,U.hemiLength=T,U.numSunShadows=g,U.numDirectionalShadows=M,U.numPointShadows=E,U.numSpotShadows=_,U.numSpotMaps=A,U.numLightProbes=N,i.version=Vx++)}function l(c,h){let d=0,u=0,f=0,g=0,w=0,p=0,m=h.matrixWorldInverse;for(let S=0,R=c.length;S<R;S++){let T=c[S];if(T.isSunLight){let M=i.sun[d];M.direction.setFromMatrixPosition(T.matrixWorld),M.direction.transformDirection(m),d++}else if(T.isDirectionalLight){let M=i.directional[u];M.direction.setFromMatrixPosition(T.matrixWorld),s.setFromMatrixPosition(T.target.matrixWorld),M.direction.sub(s),M.direction.transformDirection(m),u++}else if(T.isSpotLight){let M=i.spot[g];M.position.setFromMatrixPosition(T.matrixWorld),M.position.applyMatrix4(m),M.direction.setFromMatrixPosition(T.matrixWorld),s.setFromMatrixPosition(T.target.matrixWorld),M.direction.sub(s),M.direction.transformDirection(m),g++}else if(T.isRectAreaLight){let M=i.rectArea[w];M.position.setFromMatrixPosition(T.matrixWorld),M.position.applyMatrix4(m),o.identity(),r.copy(T.matrixWorld),r.premultiply(m),o.extractRotation(r),M.halfWidth.set(T.width*.5,0,0),M.halfHeight.set(0,T.height*.5,0),M.halfWidth.applyMatrix4(o),M.halfHeight.applyMatrix4(o),w++}else if(T.isPointLight){let M=i.point[f];M.position.setFromMatrixPosition(T.matrixWorld),M.position.applyMatrix4(m),f++}else if(T.isHemisphereLight){let M=i.hemi[p];M.direction.setFromMatrixPosition(T.matrixWorld),M.direction.transformDirection(m),p++}}}return{setup:a,setupView:l,state:i}}function Sf(n){let e=new Hx(n),t=[],i=[],s=[];function r(d){h.camera=d,t.length=0,i.length=0,s.length=0}function o(d){d.isLightProbeGrid?s.push(d):t.push(d)}function a(d){i.push(d)}function l(){e.setup(t),s.sort((d,u)=>d.priority-u.priority||d.id-u.id)}function c(d){e.setupView(t,d)}let h={lightsArray:t,shadowsArray:i,lightProbeGridArray:s,camera:null,lights:e,transmissionRenderTarget:{},textureUnits:0};return{init:r,state:h,setupLights:l,setupLightsView:c,pushLight:o,pushShadow:a}}function Wx(n){let e=new WeakMap;function t(s,r=0){let o=e.get(s),a;return o===void 0?(a=new Sf(n),e.set(s,[a])):r>=o.length?(a=new Sf(n),o.push(a)):a=o[r],a}function i(){e=new WeakMap}return{get:t,dispose:i}}var $x=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,qx=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,Xx=[new O(1,0,0),new O(-1,0,0),new O(0,1,0),new O(0,-1,0),new O(0,0,1),new O(0,0,-1)],Yx=[new O(0,-1,0),new O(0,-1,0),new O(0,0,1),new O(0,0,-1),new O(0,-1,0),new O(0,-1,0)],wf=new ut,Or=new O,Zc=new O;function Zx(n,e,t){let i=new si,s=new De,r=new De,o=new vt,a=new na,l=new ia,c={},h=t.maxTextureSize,d={[Li]:jt,[jt]:Li,[dn]:dn},u=new Vn({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new De},radius:{value:4}},vertexShader:$x,fragmentShader:qx}),f=u.clone();f.defines.HORIZONTAL_PASS=1;let g=new Gt;g.setAttribute("position",new kt(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let w=new Zt(g,u),p=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=Cr;let m=this.type;this.render=function(E,_,A){if(p.enabled===!1||p.autoUpdate===!1&&p.needsUpdate===!1||E.length===0)return;this.type===md&&(Le("WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead."),this.type=Cr);let F=n.getRenderTarget(),N=n.getActiveCubeFace(),U=n.getActiveMipmapLevel(),V=n.state;V.setBlending(ts),V.buffers.depth.getReversed()===!0?V.buffers.color.setClear(0,0,0,0):V.buffers.color.setClear(1,1,1,1),V.buffers.depth.setTest(!0),V.setScissorTest(!1);let q=m!==this.type;q&&_.traverse(function(I){I.material&&(Array.isArray(I.material)?I.material.forEach(H=>H.needsUpdate=!0):I.material.needsUpdate=!0)});for(let I=0,H=E.length;I<H;I++){let Z=E[I],W=Z.shadow;if(W===void 0){Le("WebGLShadowMap:",Z,"has no shadow.");continue}if(W.autoUpdate===!1&&W.needsUpdate===!1)continue;s.copy(W.mapSize);let ie=W.getFrameExtents();s.multiply(ie),r.copy(W.mapSize),(s.x>h||s.y>h)&&(s.x>h&&(r.x=Math.floor(h/ie.x),s.x=r.x*ie.x,W.mapSize.x=r.x),s.y>h&&(r.y=Math.floor(h/ie.y),s.y=r.y*ie.y,W.mapSize.y=r.y));let Y=n.state.buffers.depth.getReversed();if(W.camera._reversedDepth=Y,W.map===null||q===!0){if(W.map!==null&&(W.map.depthTexture!==null&&(W.map.depthTexture.dispose(),W.map.depthTexture=null),W.map.dispose()),this.type===Vs){if(Z.isPointLight){Le("WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.");continue}W.map=new Yt(s.x,s.y,{format:Di,type:Dn,minFilter:Xt,magFilter:Xt,generateMipmaps:!1}),W.map.texture.name=Z.name+".shadowMap",W.map.depthTexture=new ri(s.x,s.y,Ln),W.map.depthTexture.name=Z.name+".shadowMapDepth",W.map.depthTexture.format=ii,W.map.depthTexture.compareFunction=null,W.map.depthTexture.minFilter=yt,W.map.depthTexture.magFilter=yt}else Z.isPointLight?(W.map=new Fr(s.x),W.map.depthTexture=new Sr(s.x,In)):(W.map=new Yt(s.x,s.y),W.map.depthTexture=new ri(s.x,s.y,In)),W.map.depthTexture.name=Z.name+".shadowMap",W.map.depthTexture.format=ii,this.type===Cr?(W.map.depthTexture.compareFunction=Y?Uc:Oc,W.map.depthTexture.minFilter=Xt,W.map.depthTexture.magFilter=Xt):(W.map.depthTexture.compareFunction=null,W.map.depthTexture.minFilter=yt,W.map.depthTexture.magFilter=yt);W.camera.updateProjectionMatrix()}W.map.isWebGLCubeRenderTarget!==!0&&(W.map.width!==s.x||W.map.height!==s.y)&&W.map.setSize(s.x,s.y);let te=W.map.isWebGLCubeRenderTarget?6:W.getViewportCount();Z.isPointLight!==!0&&W.updateMatrices(Z,A);let ne=(W.camera.layers.mask&4294967294)!==0?W.camera.layers:A.layers;for(let Ae=0;Ae<te;Ae++){let ze=W.getCamera(Ae);if(Z.isPointLight){let J=W.camera,_e=W.matrix,Se=Z.distance||J.far;Se!==J.far&&(J.far=Se,J.updateProjectionMatrix()),Or.setFromMatrixPosition(Z.matrixWorld),J.position.copy(Or),Zc.copy(J.position),Zc.add(Xx[Ae]),J.up.copy(Yx[Ae]),J.lookAt(Zc),J.updateMatrixWorld(),_e.makeTranslation(-Or.x,-Or.y,-Or.z),wf.multiplyMatrices(J.projectionMatrix,J.matrixWorldInverse),W._frustum.setFromProjectionMatrix(wf,J.coordinateSystem,J.reversedDepth)}if(W.map.isWebGLCubeRenderTarget)n.setRenderTarget(W.map,Ae),n.clear();else{Ae===0&&(n.setRenderTarget(W.map),n.clear());let J=W.getViewport(Ae);o.set(r.x*J.x,r.y*J.y,r.x*J.z,r.y*J.w),V.viewport(o)}i=W.getFrustum(Ae),T(_,A,ze,Z,ne,this.type)}W.isPointLightShadow!==!0&&this.type===Vs&&S(W,A),W.needsUpdate=!1}m=this.type,p.needsUpdate=!1,n.setRenderTarget(F,N,U)};function S(E,_){let A=e.update(w);u.defines.VSM_SAMPLES!==E.blurSamples&&(u.defines.VSM_SAMPLES=E.blurSamples,f.defines.VSM_SAMPLES=E.blurSamples,u.needsUpdate=!0,f.needsUpdate=!0),E.mapPass===null?E.mapPass=new Yt(s.x,s.y,{format:Di,type:Dn}):(E.mapPass.width!==E.map.width||E.mapPass.height!==E.map.height)&&E.mapPass.setSize(E.map.width,E.map.height),u.uniforms.shadow_pass.value=E.map.depthTexture,u.uniforms.resolution.value.set(E.map.width,E.map.height),u.uniforms.radius.value=E.radius,n.setRenderTarget(E.mapPass),n.clear(),n.renderBufferDirect(_,null,A,u,w,null),f.uniforms.shadow_pass.value=E.mapPass.texture,f.uniforms.resolution.value.set(E.map.width,E.map.height),f.uniforms.radius.value=E.radius,n.setRenderTarget(E.map),n.clear(),n.renderBufferDirect(_,null,A,f,w,null)}function R(E,_,A,F){let N=null,U=A.isPointLight===!0?E.customDistanceMaterial:E.customDepthMaterial;if(U!==void 0)N=U;else if(N=A.isPointLight===!0?l:a,n.localClippingEnabled&&_.clipShadows===!0&&Array.isArray(_.clippingPlanes)&&_.clippingPlanes.length!==0||_.displacementMap&&_.displacementScale!==0||_.alphaMap&&_.alphaTest>0||_.map&&_.alphaTest>0||_.alphaToCoverage===!0){let V=N.uuid,q=_.uuid,I=c[V];I===void 0&&(I={},c[V]=I);let H=I[q];H===void 0&&(H=N.clone(),I[q]=H,_.addEventListener("dispose",M)),N=H}if(N.visible=_.visible,N.wireframe=_.wireframe,F===Vs?N.side=_.shadowSide!==null?_.shadowSide:_.side:N.side=_.shadowSide!==null?_.shadowSide:d[_.side],N.alphaMap=_.alphaMap,N.alphaTest=_.alphaToCoverage===!0?.5:_.alphaTest,N.map=_.map,N.clipShadows=_.clipShadows,N.clippingPlanes=_.clippingPlanes,N.clipIntersection=_.clipIntersection,N.displacementMap=_.displacementMap,N.displacementScale=_.displacementScale,N.displacementBias=_.displacementBias,N.wireframeLinewidth=_.wireframeLinewidth,N.linewidth=_.linewidth,A.isPointLight===!0&&N.isMeshDistanceMaterial===!0){let V=n.properties.get(N);V.light=A}return N}function T(E,_,A,F,N,U){if(E.visible===!1)return;if(E.layers.test(N)&&(E.isMesh||E.isLine||E.isPoints)&&(E.castShadow||E.receiveShadow&&U===Vs)&&(!E.frustumCulled||E.intersectsFrustum(i))){E.modelViewMatrix.multiplyMatrices(A.matrixWorldInverse,E.matrixWorld);let I=e.update(E),H=E.material;if(Array.isArray(H)){let Z=I.groups;for(let W=0,ie=Z.length;W<ie;W++){let Y=Z[W],te=H[Y.materialIndex];if(te&&te.visible){let ne=R(E,te,F,U);E.onBeforeShadow(n,E,_,A,I,ne,Y),n.renderBufferDirect(A,null,I,ne,E,Y),E.onAfterShadow(n,E,_,A,I,ne,Y)}}}else if(H.visible){let Z=R(E,H,F,U);E.onBeforeShadow(n,E,_,A,I,Z,null),n.renderBufferDirect(A,null,I,Z,E,null),E.onAfterShadow(n,E,_,A,I,Z,null)}}let q=E.children;for(let I=0,H=q.length;I<H;I++)T(q[I],_,A,F,N,U)}function M(E){E.target.removeEventListener("dispose",M);for(let A in c){let F=c[A],N=E.target.uuid;N in F&&(F[N].dispose(),delete F[N])}}}function jx(n,e){function t(){let P=!1,Q=new vt,X=null,he=new vt(0,0,0,0);return{setMask:function(oe){X!==oe&&!P&&(n.colorMask(oe,oe,oe,oe),X=oe)},setLocked:function(oe){P=oe},setClear:function(oe,le,Ee,$e,re){re===!0&&(oe*=$e,le*=$e,Ee*=$e),Q.set(oe,le,Ee,$e),he.equals(Q)===!1&&(n.clearColor(oe,le,Ee,$e),he.copy(Q))},reset:function(){P=!1,X=null,he.set(-1,0,0,0)}}}function i(){let P=!1,Q=!1,X=null,he=null,oe=null;return{setReversed:function(le){if(Q!==le){let Ee=e.get("EXT_clip_control");le?Ee.clipControlEXT(Ee.LOWER_LEFT_EXT,Ee.ZERO_TO_ONE_EXT):Ee.clipControlEXT(Ee.LOWER_LEFT_EXT,Ee.NEGATIVE_ONE_TO_ONE_EXT),Q=le;let $e=oe;oe=null,this.setClear($e)}},getReversed:function(){return Q},setTest:function(le){le?ve(n.DEPTH_TEST):Ge(n.DEPTH_TEST)},setMask:function(le){X!==le&&!P&&(n.depthMask(le),X=le)},setFunc:function(le){if(Q&&(le=Zd[le]),he!==le){switch(le){case Bo:n.depthFunc(n.NEVER);break;case Vo:n.depthFunc(n.ALWAYS);break;case Go:n.depthFunc(n.LESS);break;case Ps:n.depthFunc(n.LEQUAL);break;case Ho:n.depthFunc(n.EQUAL);break;case Wo:n.depthFunc(n.GEQUAL);break;case $o:n.depthFunc(n.GREATER);break;case qo:n.depthFunc(n.NOTEQUAL);break;default:n.depthFunc(n.LEQUAL)}he=le}},setLocked:function(le){P=le},setClear:function(le){oe!==le&&(oe=le,Q&&(le=1-le),n.clearDepth(le))},reset:function(){P=!1,X=null,he=null,oe=null,Q=!1}}}function s(){let P=!1,Q=null,X=null,he=null,oe=null,le=null,Ee=null,$e=null,re=null;return{setTest:function(Ce){P||(Ce?ve(n.STENCIL_TEST):Ge(n.STENCIL_TEST))},setMask:function(Ce){Q!==Ce&&!P&&(n.stencilMask(Ce),Q=Ce)},setFunc:function(Ce,We,me){(X!==Ce||he!==We||oe!==me)&&(n.stencilFunc(Ce,We,me),X=Ce,he=We,oe=me)},setOp:function(Ce,We,me){(le!==Ce||Ee!==We||$e!==me)&&(n.stencilOp(Ce,We,me),le=Ce,Ee=We,$e=me)},setLocked:function(Ce){P=Ce},setClear:function(Ce){re!==Ce&&(n.clearStencil(Ce),re=Ce)},reset:function(){P=!1,Q=null,X=null,he=null,oe=null,le=null,Ee=null,$e=null,re=null}}}let r=new t,o=new i,a=new s,l={},c=new WeakMap,h={},d={},u={},f=new WeakMap,g=[],w=null,p=!1,m=null,S=null,R=null,T=null,M=null,E=null,_=null,A=new Ve(0,0,0),F=0,N=!1,U=null,V=null,q=null,I=null,H=null,Z=n.getParameter(n.MAX_COMBINED_TEXTURE_IMAGE_UNITS),W=!1,ie=0,Y=n.getParameter(n.VERSION);Y.indexOf("WebGL")!==-1?(ie=parseFloat(/^WebGL (\d)/.exec(Y)[1]),W=ie>=1):Y.indexOf("OpenGL ES")!==-1&&(ie=parseFloat(/^OpenGL ES (\d)/.exec(Y)[1]),W=ie>=2);let te=null,ne={},Ae=n.getParameter(n.SCISSOR_BOX),ze=n.getParameter(n.VIEWPORT),J=new vt().fromArray(Ae),_e=new vt().fromArray(ze);function Se(P,Q,X,he){let oe=new Uint8Array(4),le=n.createTexture();n.bindTexture(P,le),n.texParameteri(P,n.TEXTURE_MIN_FILTER,n.NEAREST),n.texParameteri(P,n.TEXTURE_MAG_FILTER,n.NEAREST);for(let Ee=0;Ee<X;Ee++)P===n.TEXTURE_3D||P===n.TEXTURE_2D_ARRAY?n.texImage3D(Q,0,n.RGBA,1,1,he,0,n.RGBA,n.UNSIGNED_BYTE,oe):n.texImage2D(Q+Ee,0,n.RGBA,1,1,0,n.RGBA,n.UNSIGNED_BYTE,oe);return le}let Re={};Re[n.TEXTURE_2D]=Se(n.TEXTURE_2D,n.TEXTURE_2D,1),Re[n.TEXTURE_CUBE_MAP]=Se(n.TEXTURE_CUBE_MAP,n.TEXTURE_CUBE_MAP_POSITIVE_X,6),Re[n.TEXTURE_2D_ARRAY]=Se(n.TEXTURE_2D_ARRAY,n.TEXTURE_2D_ARRAY,1,1),Re[n.TEXTURE_3D]=Se(n.TEXTURE_3D,n.TEXTURE_3D,1,1),r.setClear(0,0,0,1),o.setClear(1),a.setClear(0),ve(n.DEPTH_TEST),o.setFunc(Ps),Jt(!1),gt(fc),ve(n.CULL_FACE),Ot(ts);function ve(P){h[P]!==!0&&(n.enable(P),h[P]=!0)}function Ge(P){h[P]!==!1&&(n.disable(P),h[P]=!1)}function bt(P,Q){return u[P]!==Q?(n.bindFramebuffer(P,Q),u[P]=Q,P===n.DRAW_FRAMEBUFFER&&(u[n.FRAMEBUFFER]=Q),P===n.FRAMEBUFFER&&(u[n.DRAW_FRAMEBUFFER]=Q),!0):!1}function Ne(P,Q){let X=g,he=!1;if(P){X=f.get(Q),X===void 0&&(X=[],f.set(Q,X));let oe=P.textures;if(X.length!==oe.length||X[0]!==n.COLOR_ATTACHMENT0){for(let le=0,Ee=oe.length;le<Ee;le++)X[le]=n.COLOR_ATTACHMENT0+le;X.length=oe.length,he=!0}}else X[0]!==n.BACK&&(X[0]=n.BACK,he=!0);he&&n.drawBuffers(X)}function rt(P){return w!==P?(n.useProgram(P),w=P,!0):!1}let ct={[ns]:n.FUNC_ADD,[_d]:n.FUNC_SUBTRACT,[vd]:n.FUNC_REVERSE_SUBTRACT};ct[xd]=n.MIN,ct[yd]=n.MAX;let Ye={[bd]:n.ZERO,[Sd]:n.ONE,[wd]:n.SRC_COLOR,[_c]:n.SRC_ALPHA,[Rd]:n.SRC_ALPHA_SATURATE,[Ed]:n.DST_COLOR,[Ad]:n.DST_ALPHA,[Md]:n.ONE_MINUS_SRC_COLOR,[vc]:n.ONE_MINUS_SRC_ALPHA,[Cd]:n.ONE_MINUS_DST_COLOR,[Td]:n.ONE_MINUS_DST_ALPHA,[Pd]:n.CONSTANT_COLOR,[Id]:n.ONE_MINUS_CONSTANT_COLOR,[Ld]:n.CONSTANT_ALPHA,[Dd]:n.ONE_MINUS_CONSTANT_ALPHA};function Ot(P,Q,X,he,oe,le,Ee,$e,re,Ce){if(P===ts){p===!0&&(Ge(n.BLEND),p=!1);return}if(p===!1&&(ve(n.BLEND),p=!0),P!==gd){if(P!==m||Ce!==N){if((S!==ns||M!==ns)&&(n.blendEquation(n.FUNC_ADD),S=ns,M=ns),Ce)switch(P){case Gs:n.blendFuncSeparate(n.ONE,n.ONE_MINUS_SRC_ALPHA,n.ONE,n.ONE_MINUS_SRC_ALPHA);break;case pc:n.blendFunc(n.ONE,n.ONE);break;case mc:n.blendFuncSeparate(n.ZERO,n.ONE_MINUS_SRC_COLOR,n.ZERO,n.ONE);break;case gc:n.blendFuncSeparate(n.DST_COLOR,n.ONE_MINUS_SRC_ALPHA,n.ZERO,n.ONE);break;default:Oe("WebGLState: Invalid blending: ",P);break}else switch(P){case Gs:n.blendFuncSeparate(n.SRC_ALPHA,n.ONE_MINUS_SRC_ALPHA,n.ONE,n.ONE_MINUS_SRC_ALPHA);break;case pc:n.blendFuncSeparate(n.SRC_ALPHA,n.ONE,n.ONE,n.ONE);break;case mc:Oe("WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true");break;case gc:Oe("WebGLState: MultiplyBlending requires material.premultipliedAlpha = true");break;default:Oe("WebGLState: Invalid blending: ",P);break}R=null,T=null,E=null,_=null,A.set(0,0,0),F=0,m=P,N=Ce}return}oe=oe||Q,le=le||X,Ee=Ee||he,(Q!==S||oe!==M)&&(n.blendEquationSeparate(ct[Q],ct[oe]),S=Q,M=oe),(X!==R||he!==T||le!==E||Ee!==_)&&(n.blendFuncSeparate(Ye[X],Ye[he],Ye[le],Ye[Ee]),R=X,T=he,E=le,_=Ee),($e.equals(A)===!1||re!==F)&&(n.blendColor($e.r,$e.g,$e.b,re),A.copy($e),F=re),m=P,N=!1}function At(P,Q){P.side===dn?Ge(n.CULL_FACE):ve(n.CULL_FACE);let X=P.side===jt;Q&&(X=!X),Jt(X),P.blending===Gs&&P.transparent===!1?Ot(ts):Ot(P.blending,P.blendEquation,P.blendSrc,P.blendDst,P.blendEquationAlpha,P.blendSrcAlpha,P.blendDstAlpha,P.blendColor,P.blendAlpha,P.premultipliedAlpha),o.setFunc(P.depthFunc),o.setTest(P.depthTest),o.setMask(P.depthWrite),r.setMask(P.colorWrite);let he=P.stencilWrite;a.setTest(he),he&&(a.setMask(P.stencilWriteMask),a.setFunc(P.stencilFunc,P.stencilRef,P.stencilFuncMask),a.setOp(P.stencilFail,P.stencilZFail,P.stencilZPass)),It(P.polygonOffset,P.polygonOffsetFactor,P.polygonOffsetUnits),P.alphaToCoverage===!0?ve(n.SAMPLE_ALPHA_TO_COVERAGE):Ge(n.SAMPLE_ALPHA_TO_COVERAGE)}function Jt(P){U!==P&&(P?n.frontFace(n.CW):n.frontFace(n.CCW),U=P)}function gt(P){P!==fd?(ve(n.CULL_FACE),P!==V&&(P===fc?n.cullFace(n.BACK):P===pd?n.cullFace(n.FRONT):n.cullFace(n.FRONT_AND_BACK))):Ge(n.CULL_FACE),V=P}function kn(P){P!==q&&(W&&n.lineWidth(P),q=P)}function It(P,Q,X){P?(ve(n.POLYGON_OFFSET_FILL),(I!==Q||H!==X)&&(I=Q,H=X,o.getReversed()&&(Q=-Q,X=-X),n.polygonOffset(Q,X))):Ge(n.POLYGON_OFFSET_FILL)}function fn(P){P?ve(n.SCISSOR_TEST):Ge(n.SCISSOR_TEST)}function pn(P){P===void 0&&(P=n.TEXTURE0+Z-1),te!==P&&(n.activeTexture(P),te=P)}function mn(P,Q,X){X===void 0&&(te===null?X=n.TEXTURE0+Z-1:X=te);let he=ne[X];he===void 0&&(he={type:void 0,texture:void 0},ne[X]=he),(he.type!==P||he.texture!==Q)&&(te!==X&&(n.activeTexture(X),te=X),n.bindTexture(P,Q||Re[P]),he.type=P,he.texture=Q)}function k(){let P=ne[te];P!==void 0&&P.type!==void 0&&(n.bindTexture(P.type,null),P.type=void 0,P.texture=void 0)}function gn(){try{n.compressedTexImage2D(...arguments)}catch(P){Oe("WebGLState:",P)}}function pt(){try{n.compressedTexImage3D(...arguments)}catch(P){Oe("WebGLState:",P)}}function mt(){try{n.texSubImage2D(...arguments)}catch(P){Oe("WebGLState:",P)}}function pe(){try{n.texSubImage3D(...arguments)}catch(P){Oe("WebGLState:",P)}}function Tt(){try{n.compressedTexSubImage2D(...arguments)}catch(P){Oe("WebGLState:",P)}}function Pe(){try{n.compressedTexSubImage3D(...arguments)}catch(P){Oe("WebGLState:",P)}}function Fe(){try{n.texStorage2D(...arguments)}catch(P){Oe("WebGLState:",P)}}function C(){try{n.texStorage3D(...arguments)}catch(P){Oe("WebGLState:",P)}}function y(){try{n.texImage2D(...arguments)}catch(P){Oe("WebGLState:",P)}}function B(){try{n.texImage3D(...arguments)}catch(P){Oe("WebGLState:",P)}}function se(P){return d[P]!==void 0?d[P]:n.getParameter(P)}function ee(P,Q){d[P]!==Q&&(n.pixelStorei(P,Q),d[P]=Q)}function ae(P){J.equals(P)===!1&&(n.scissor(P.x,P.y,P.z,P.w),J.copy(P))}function de(P){_e.equals(P)===!1&&(n.viewport(P.x,P.y,P.z,P.w),_e.copy(P))}function j(P,Q){let X=c.get(Q);X===void 0&&(X=new WeakMap,c.set(Q,X));let he=X.get(P);he===void 0&&(he=n.getUniformBlockIndex(Q,P.name),n.uniformBlockBinding(Q,he,he),X.set(P,he))}function K(P,Q,X){let oe=c.get(Q).get(P);l[oe]!==X&&(n.bindBufferBase(n.UNIFORM_BUFFER,oe,X),l[oe]=X)}function ce(){n.disable(n.BLEND),n.disable(n.CULL_FACE),n.disable(n.DEPTH_TEST),n.disable(n.POLYGON_OFFSET_FILL),n.disable(n.SCISSOR_TEST),n.disable(n.STENCIL_TEST),n.disable(n.SAMPLE_ALPHA_TO_COVERAGE),n.blendEquation(n.FUNC_ADD),n.blendFunc(n.ONE,n.ZERO),n.blendFuncSeparate(n.ONE,n.ZERO,n.ONE,n.ZERO),n.blendColor(0,0,0,0),n.colorMask(!0,!0,!0,!0),n.clearColor(0,0,0,0),n.depthMask(!0),n.depthFunc(n.LESS),o.setReversed(!1),n.clearDepth(1),n.stencilMask(4294967295),n.stencilFunc(n.ALWAYS,0,4294967295),n.stencilOp(n.KEEP,n.KEEP,n.KEEP),n.clearStencil(0),n.cullFace(n.BACK),n.frontFace(n.CCW),n.polygonOffset(0,0),n.activeTexture(n.TEXTURE0),n.bindFramebuffer(n.FRAMEBUFFER,null),n.bindFramebuffer(n.DRAW_FRAMEBUFFER,null),n.bindFramebuffer(n.READ_FRAMEBUFFER,null),n.useProgram(null),n.lineWidth(1),n.scissor(0,0,n.canvas.width,n.canvas.height),n.viewport(0,0,n.canvas.width,n.canvas.height),n.pixelStorei(n.PACK_ALIGNMENT,4),n.pixelStorei(n.UNPACK_ALIGNMENT,4),n.pixelStorei(n.UNPACK_FLIP_Y_WEBGL,!1),n.pixelStorei(n.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),n.pixelStorei(n.UNPACK_COLORSPACE_CONVERSION_WEBGL,n.BROWSER_DEFAULT_WEBGL),n.pixelStorei(n.PACK_ROW_LENGTH,0),n.pixelStorei(n.PACK_SKIP_PIXELS,0),n.pixelStorei(n.PACK_SKIP_ROWS,0),n.pixelStorei(n.UNPACK_ROW_LENGTH,0),n.pixelStorei(n.UNPACK_IMAGE_HEIGHT,0),n.pixelStorei(n.UNPACK_SKIP_PIXELS,0),n.pixelStorei(n.UNPACK_SKIP_ROWS,0),n.pixelStorei(n.UNPACK_SKIP_IMAGES,0),h={},d={},te=null,ne={},u={},l={},f=new WeakMap,g=[],w=null,p=!1,m=null,S=null,R=null,T=null,M=null,E=null,_=null,A=new Ve(0,0,0),F=0,N=!1,U=null,V=null,q=null,I=null,H=null,J.set(0,0,n.canvas.width,n.canvas.height),_e.set(0,0,n.canvas.width,n.canvas.height),r.reset(),o.reset(),a.reset()}return{buffers:{color:r,depth:o,stencil:a},enable:ve,disable:Ge,bindFramebuffer:bt,drawBuffers:Ne,useProgram:rt,setBlending:Ot,setMaterial:At,setFlipSided:Jt,setCullFace:gt,setLineWidth:kn,setPolygonOffset:It,setScissorTest:fn,activeTexture:pn,bindTexture:mn,unbindTexture:k,compressedTexImage2D:gn,compressedTexImage3D:pt,texImage2D:y,texImage3D:B,pixelStorei:ee,getParameter:se,updateUBOMapping:j,uniformBlockBinding:K,texStorage2D:Fe,texStorage3D:C,texSubImage2D:mt,texSubImage3D:pe,compressedTexSubImage2D:Tt,compressedTexSubImage3D:Pe,scissor:ae,viewport:de,reset:ce}}function Kx(n,e,t,i,s,r,o){let a=e.has("WEBGL_multisampled_render_to_texture")?e.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new De,h=new WeakMap,d=new Set,u,f=new WeakMap,g=new Set,w=new FinalizationRegistry(C=>g.delete(C)),p=!1;try{p=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function m(C,y){return p?new OffscreenCanvas(C,y):gr("canvas")}function S(C,y,B){let se=1,ee=Fe(C);if((ee.width>B||ee.height>B)&&(se=B/Math.max(ee.width,ee.height)),se<1)if(typeof HTMLImageElement<"u"&&C instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&C instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&C instanceof ImageBitmap||typeof VideoFrame<"u"&&C instanceof VideoFrame){let ae=Math.floor(se*ee.width),de=Math.floor(se*ee.height);u===void 0&&(u=m(ae,de));let j=y?m(ae,de):u;return j.width=ae,j.height=de,j.getContext("2d").drawImage(C,0,0,ae,de),Le("WebGLRenderer: Texture has been resized from ("+ee.width+"x"+ee.height+") to ("+ae+"x"+de+")."),j}else return"data"in C&&Le("WebGLRenderer: Image in DataTexture is too big ("+ee.width+"x"+ee.height+")."),C;return C}function R(C){return C.generateMipmaps}function T(C){n.generateMipmap(C)}function M(C){return C.isWebGLCubeRenderTarget?n.TEXTURE_CUBE_MAP:C.isWebGL3DRenderTarget?n.TEXTURE_3D:C.isWebGLArrayRenderTarget||C.isCompressedArrayTexture?n.TEXTURE_2D_ARRAY:n.TEXTURE_2D}function E(C,y,B,se,ee,ae=!1){if(C!==null){if(n[C]!==void 0)return n[C];Le("WebGLRenderer: Attempt to use non-existing WebGL internal format '"+C+"'")}let de;se&&(de=e.get("EXT_texture_norm16"),de||Le("WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension"));let j=y;if(y===n.RED&&(B===n.FLOAT&&(j=n.R32F),B===n.HALF_FLOAT&&(j=n.R16F),B===n.UNSIGNED_BYTE&&(j=n.R8),B===n.UNSIGNED_SHORT&&de&&(j=de.R16_EXT),B===n.SHORT&&de&&(j=de.R16_SNORM_EXT)),y===n.RED_INTEGER&&(B===n.UNSIGNED_BYTE&&(j=n.R8UI),B===n.UNSIGNED_SHORT&&(j=n.R16UI),B===n.UNSIGNED_INT&&(j=n.R32UI),B===n.BYTE&&(j=n.R8I),B===n.SHORT&&(j=n.R16I),B===n.INT&&(j=n.R32I)),y===n.RG&&(B===n.FLOAT&&(j=n.RG32F),B===n.HALF_FLOAT&&(j=n.RG16F),B===n.UNSIGNED_BYTE&&(j=n.RG8),B===n.UNSIGNED_SHORT&&de&&(j=de.RG16_EXT),B===n.SHORT&&de&&(j=de.RG16_SNORM_EXT)),y===n.RG_INTEGER&&(B===n.UNSIGNED_BYTE&&(j=n.RG8UI),B===n.UNSIGNED_SHORT&&(j=n.RG16UI),B===n.UNSIGNED_INT&&(j=n.RG32UI),B===n.BYTE&&(j=n.RG8I),B===n.SHORT&&(j=n.RG16I),B===n.INT&&(j=n.RG32I)),y===n.RGB_INTEGER&&(B===n.UNSIGNED_BYTE&&(j=n.RGB8UI),B===n.UNSIGNED_SHORT&&(j=n.RGB16UI),B===n.UNSIGNED_INT&&(j=n.RGB32UI),B===n.BYTE&&(j=n.RGB8I),B===n.SHORT&&(j=n.RGB16I),B===n.INT&&(j=n.RGB32I)),y===n.RGBA_INTEGER&&(B===n.UNSIGNED_BYTE&&(j=n.RGBA8UI),B===n.UNSIGNED_SHORT&&(j=n.RGBA16UI),B===n.UNSIGNED_INT&&(j=n.RGBA32UI),B===n.BYTE&&(j=n.RGBA8I),B===n.SHORT&&(j=n.RGBA16I),B===n.INT&&(j=n.RGBA32I)),y===n.RGB&&(B===n.UNSIGNED_SHORT&&de&&(j=de.RGB16_EXT),B===n.SHORT&&de&&(j=de.RGB16_SNORM_EXT),B===n.UNSIGNED_INT_5_9_9_9_REV&&(j=n.RGB9_E5),B===n.UNSIGNED_INT_10F_11F_11F_REV&&(j=n.R11F_G11F_B10F)),y===n.RGBA){let K=ae?pr:Ke.getTransfer(ee);B===n.FLOAT&&(j=n.RGBA32F),B===n.HALF_FLOAT&&(j=n.RGBA16F),B===n.UNSIGNED_BYTE&&(j=K===st?n.SRGB8_ALPHA8:n.RGBA8),B===n.UNSIGNED_SHORT&&de&&(j=de.RGBA16_EXT),B===n.SHORT&&de&&(j=de.RGBA16_SNORM_EXT),B===n.UNSIGNED_SHORT_4_4_4_4&&(j=n.RGBA4),B===n.UNSIGNED_SHORT_5_5_5_1&&(j=n.RGB5_A1)}return(j===n.R16F||j===n.R32F||j===n.RG16F||j===n.RG32F||j===n.RGBA16F||j===n.RGBA32F)&&e.get("EXT_color_buffer_float"),j}function _(C,y){let B;return C?y===null||y===In||y===ss?B=n.DEPTH24_STENCIL8:y===Ln?B=n.DEPTH32F_STENCIL8:y===Ws&&(B=n.DEPTH24_STENCIL8,Le("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):y===null||y===In||y===ss?B=n.DEPTH_COMPONENT24:y===Ln?B=n.DEPTH_COMPONENT32F:y===Ws&&(B=n.DEPTH_COMPONENT16),B}function A(C,y){return R(C)===!0||C.isFramebufferTexture&&C.minFilter!==yt&&C.minFilter!==Xt?Math.log2(Math.max(y.width,y.height))+1:C.mipmaps.length>0?C.mipmaps.length:C.isCompressedTexture&&Array.isArray(C.image)?y.mipmaps.length:1}function F(C){let y=new WeakRef(C);i.get(C).__ref=y,g.add(y),w.register(C,y,y)}function N(C){let y=i.get(C).__ref;y!==void 0&&(g.delete(y),w.unregister(y))}function U(C){q(C.target)}function V(C){I(C.target)}function q(C){C.removeEventListener("dispose",U),N(C),Z(C),C.isVideoTexture&&h.delete(C),C.isHTMLTexture&&d.delete(C)}function I(C){C.removeEventListener("dispose",V),N(C),ie(C)}function H(){for(let C of g){let y=C.deref();y!==void 0&&(y.isRenderTarget===!0?I(y):q(y))}g.clear(),d.clear()}function Z(C){let y=i.get(C);if(y.__webglInit===void 0)return;let B=C.source,se=f.get(B);if(se){let ee=se[y.__cacheKey];ee.usedTimes--,ee.usedTimes===0&&W(C),Object.keys(se).length===0&&f.delete(B)}i.remove(C)}function W(C){let y=i.get(C);n.deleteTexture(y.__webglTexture);let B=C.source,se=f.get(B);delete se[y.__cacheKey],o.memory.textures--}function ie(C){let y=i.get(C);y.__depthDisposeCallback&&y.__depthDisposeCallback();let B=C.depthTexture;if(B&&B.renderTarget===C&&q(B),C.isWebGLCubeRenderTarget)for(let ee=0;ee<6;ee++){if(Array.isArray(y.__webglFramebuffer[ee]))for(let ae=0;ae<y.__webglFramebuffer[ee].length;ae++)n.deleteFramebuffer(y.__webglFramebuffer[ee][ae]);else n.deleteFramebuffer(y.__webglFramebuffer[ee]);y.__webglDepthbuffer&&n.deleteRenderbuffer(y.__webglDepthbuffer[ee])}else{if(Array.isArray(y.__webglFramebuffer))for(let ee=0;ee<y.__webglFramebuffer.length;ee++)n.deleteFramebuffer(y.__webglFramebuffer[ee]);else n.deleteFramebuffer(y.__webglFramebuffer);if(y.__webglDepthbuffer&&n.deleteRenderbuffer(y.__webglDepthbuffer),y.__webglMultisampledFramebuffer&&n.deleteFramebuffer(y.__webglMultisampledFramebuffer),y.__webglColorRenderbuffer)for(let ee=0;ee<y.__webglColorRenderbuffer.length;ee++)y.__webglColorRenderbuffer[ee]&&n.deleteRenderbuffer(y.__webglColorRenderbuffer[ee]);y.__webglDepthRenderbuffer&&n.deleteRenderbuffer(y.__webglDepthRenderbuffer)}let se=C.textures;for(let ee=0,ae=se.length;ee<ae;ee++){let de=i.get(se[ee]);de.__webglTexture&&(n.deleteTexture(de.__webglTexture),o.memory.textures--),i.remove(se[ee])}i.remove(C)}let Y=0;function te(){Y=0}function ne(){return Y}function Ae(C){Y=C}function ze(){let C=Y;return C>=s.maxTextures&&Le("WebGLTextures: Trying to use "+(C+1)+" texture units while this GPU supports only "+s.maxTextures),Y+=1,C}function J(C){let y=[];return y.push(C.wrapS),y.push(C.wrapT),y.push(C.wrapR||0),y.push(C.magFilter),y.push(C.minFilter),y.push(C.anisotropy),y.push(C.internalFormat),y.push(C.format),y.push(C.type),y.push(C.generateMipmaps),y.push(C.mipmapsAutoUpdate),y.push(C.premultiplyAlpha),y.push(C.flipY),y.push(C.unpackAlignment),y.push(C.colorSpace),y.join()}function _e(C,y){let B=i.get(C);if(C.isVideoTexture&&Tt(C),C.isRenderTargetTexture===!1&&C.isExternalTexture!==!0&&C.version>0&&B.__version!==C.version){let se=C.image;if(se===null)Le("WebGLRenderer: Texture marked for update but no image data found.");else if(se.complete===!1)Le("WebGLRenderer: Texture marked for update but image is incomplete");else{At(B,C,y);return}}else C.isExternalTexture&&(B.__webglTexture=C.sourceTexture?C.sourceTexture:null);t.bindTexture(n.TEXTURE_2D,B.__webglTexture,n.TEXTURE0+y)}function Se(C,y){let B=i.get(C);if(C.isRenderTargetTexture===!1&&C.version>0&&B.__version!==C.version){At(B,C,y);return}else C.isExternalTexture&&(B.__webglTexture=C.sourceTexture?C.sourceTexture:null);t.bindTexture(n.TEXTURE_2D_ARRAY,B.__webglTexture,n.TEXTURE0+y)}function Re(C,y){let B=i.get(C);if(C.isRenderTargetTexture===!1&&C.version>0&&B.__version!==C.version){At(B,C,y);return}t.bindTexture(n.TEXTURE_3D,B.__webglTexture,n.TEXTURE0+y)}function ve(C,y){let B=i.get(C);if(C.version>0&&B.__version!==C.version){Jt(B,C,y);return}t.bindTexture(n.TEXTURE_CUBE_MAP,B.__webglTexture,n.TEXTURE0+y)}let Ge={[Xo]:n.REPEAT,[zn]:n.CLAMP_TO_EDGE,[Yo]:n.MIRRORED_REPEAT},bt={[yt]:n.NEAREST,[Od]:n.NEAREST_MIPMAP_NEAREST,[Rr]:n.NEAREST_MIPMAP_LINEAR,[Xt]:n.LINEAR,[_a]:n.LINEAR_MIPMAP_NEAREST,[oi]:n.LINEAR_MIPMAP_LINEAR},Ne={[Bd]:n.NEVER,[Fc]:n.ALWAYS,[Vd]:n.LESS,[Oc]:n.LEQUAL,[Gd]:n.EQUAL,[Uc]:n.GEQUAL,[Hd]:n.GREATER,[Wd]:n.NOTEQUAL};function rt(C,y){if(y.type===Ln&&e.has("OES_texture_float_linear")===!1&&(y.magFilter===Xt||y.magFilter===_a||y.magFilter===Rr||y.magFilter===oi||y.minFilter===Xt||y.minFilter===_a||y.minFilter===Rr||y.minFilter===oi)&&Le("WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),n.texParameteri(C,n.TEXTURE_WRAP_S,Ge[y.wrapS]),n.texParameteri(C,n.TEXTURE_WRAP_T,Ge[y.wrapT]),(C===n.TEXTURE_3D||C===n.TEXTURE_2D_ARRAY)&&n.texParameteri(C,n.TEXTURE_WRAP_R,Ge[y.wrapR]),n.texParameteri(C,n.TEXTURE_MAG_FILTER,bt[y.magFilter]),n.texParameteri(C,n.TEXTURE_MIN_FILTER,bt[y.minFilter]),y.compareFunction&&(n.texParameteri(C,n.TEXTURE_COMPARE_MODE,n.COMPARE_REF_TO_TEXTURE),n.texParameteri(C,n.TEXTURE_COMPARE_FUNC,Ne[y.compareFunction])),e.has("EXT_texture_filter_anisotropic")===!0){if(y.magFilter===yt||y.minFilter!==Rr&&y.minFilter!==oi||y.type===Ln&&e.has("OES_texture_float_linear")===!1)return;if(y.anisotropy>1||i.get(y).__currentAnisotropy){let B=e.get("EXT_texture_filter_anisotropic");n.texParameterf(C,B.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(y.anisotropy,s.getMaxAnisotropy())),i.get(y).__currentAnisotropy=y.anisotropy}}}function ct(C,y){let B=!1;C.__webglInit===void 0&&(C.__webglInit=!0,y.addEventListener("dispose",U),F(y));let se=y.source,ee=f.get(se);ee===void 0&&(ee={},f.set(se,ee));let ae=J(y);if(ae!==C.__cacheKey){ee[ae]===void 0&&(ee[ae]={texture:n.createTexture(),usedTimes:0},o.memory.textures++,B=!0),ee[ae].usedTimes++;let de=ee[C.__cacheKey];de!==void 0&&(ee[C.__cacheKey].usedTimes--,de.usedTimes===0&&W(y)),C.__cacheKey=ae,C.__webglTexture=ee[ae].texture}return B}function Ye(C,y,B){return Math.floor(Math.floor(C/B)/y)}function Ot(C,y,B,se){let ae=C.updateRanges;if(ae.length===0)t.texSubImage2D(n.TEXTURE_2D,0,0,0,y.width,y.height,B,se,y.data);else{ae.sort((P,Q)=>P.start-Q.start);let de=0;for(let P=1;P<ae.length;P++){let Q=ae[de],X=ae[P],he=Q.start+Q.count,oe=Ye(X.start,y.width,4),le=Ye(Q.start,y.width,4);X.start<=he+1&&oe===le&&Ye(X.start+X.count-1,y.width,4)===oe?Q.count=Math.max(Q.count,X.start+X.count-Q.start):(++de,ae[de]=X)}ae.length=de+1;let j=t.getParameter(n.UNPACK_ROW_LENGTH),K=t.getParameter(n.UNPACK_SKIP_PIXELS),ce=t.getParameter(n.UNPACK_SKIP_ROWS);t.pixelStorei(n.UNPACK_ROW_LENGTH,y.width);for(let P=0,Q=ae.length;P<Q;P++){let X=ae[P],he=Math.floor(X.start/4),oe=Math.ceil(X.count/4),le=he%y.width,Ee=Math.floor(he/y.width),$e=oe,re=1;t.pixelStorei(n.UNPACK_SKIP_PIXELS,le),t.pixelStorei(n.UNPACK_SKIP_ROWS,Ee),t.texSubImage2D(n.TEXTURE_2D,0,le,Ee,$e,re,B,se,y.data)}C.clearUpdateRanges(),t.pixelStorei(n.UNPACK_ROW_LENGTH,j),t.pixelStorei(n.UNPACK_SKIP_PIXELS,K),t.pixelStorei(n.UNPACK_SKIP_ROWS,ce)}}function At(C,y,B){let se=n.TEXTURE_2D;(y.isDataArrayTexture||y.isCompressedArrayTexture)&&(se=n.TEXTURE_2D_ARRAY),y.isData3DTexture&&(se=n.TEXTURE_3D);let ee=ct(C,y),ae=y.source;t.bindTexture(se,C.__webglTexture,n.TEXTURE0+B);let de=i.get(ae);if(ae.version!==de.__version||ee===!0){if(t.activeTexture(n.TEXTURE0+B),(typeof ImageBitmap<"u"&&y.image instanceof ImageBitmap)===!1){let re=Ke.getPrimaries(Ke.workingColorSpace),Ce=y.colorSpace===li?null:Ke.getPrimaries(y.colorSpace),We=y.colorSpace===li||re===Ce?n.NONE:n.BROWSER_DEFAULT_WEBGL;t.pixelStorei(n.UNPACK_FLIP_Y_WEBGL,y.flipY),t.pixelStorei(n.UNPACK_PREMULTIPLY_ALPHA_WEBGL,y.premultiplyAlpha),t.pixelStorei(n.UNPACK_COLORSPACE_CONVERSION_WEBGL,We)}t.pixelStorei(n.UNPACK_ALIGNMENT,y.unpackAlignment);let K=S(y.image,!1,s.maxTextureSize);K=Pe(y,K);let ce=r.convert(y.format,y.colorSpace),P=r.convert(y.type),Q=E(y.internalFormat,ce,P,y.normalized,y.colorSpace,y.isVideoTexture);rt(se,y);let X,he=y.mipmaps,oe=y.isVideoTexture!==!0,le=de.__version===void 0||ee===!0,Ee=ae.dataReady,$e=A(y,K);if(y.isDepthTexture)Q=_(y.format===ai,y.type),le&&(oe?t.texStorage2D(n.TEXTURE_2D,1,Q,K.width,K.height):t.texImage2D(n.TEXTURE_2D,0,Q,K.width,K.height,0,ce,P,null));else if(y.isDataTexture)if(he.length>0){oe&&le&&t.texStorage2D(n.TEXTURE_2D,$e,Q,he[0].width,he[0].height);for(let re=0,Ce=he.length;re<Ce;re++)X=he[re],oe?Ee&&t.texSubImage2D(n.TEXTURE_2D,re,0,0,X.width,X.height,ce,P,X.data):t.texImage2D(n.TEXTURE_2D,re,Q,X.width,X.height,0,ce,P,X.data);y.generateMipmaps=!1}else oe?(le&&t.texStorage2D(n.TEXTURE_2D,$e,Q,K.width,K.height),Ee&&Ot(y,K,ce,P)):t.texImage2D(n.TEXTURE_2D,0,Q,K.width,K.height,0,ce,P,K.data);else if(y.isCompressedTexture)if(y.isCompressedArrayTexture){oe&&le&&t.texStorage3D(n.TEXTURE_2D_ARRAY,$e,Q,he[0].width,he[0].height,K.depth);for(let re=0,Ce=he.length;re<Ce;re++)if(X=he[re],y.format!==tn)if(ce!==null)if(oe){if(Ee)if(y.layerUpdates.size>0){let We=Xc(X.width,X.height,y.format,y.type);for(let me of y.layerUpdates){let ot=X.data.subarray(me*We/X.data.BYTES_PER_ELEMENT,(me+1)*We/X.data.BYTES_PER_ELEMENT);t.compressedTexSubImage3D(n.TEXTURE_2D_ARRAY,re,0,0,me,X.width,X.height,1,ce,ot)}}else t.compressedTexSubImage3D(n.TEXTURE_2D_ARRAY,re,0,0,0,X.width,X.height,K.depth,ce,X.data)}else t.compressedTexImage3D(n.TEXTURE_2D_ARRAY,re,Q,X.width,X.height,K.depth,0,X.data,0,0);else Le("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else oe?Ee&&t.texSubImage3D(n.TEXTURE_2D_ARRAY,re,0,0,0,X.width,X.height,K.depth,ce,P,X.data):t.texImage3D(n.TEXTURE_2D_ARRAY,re,Q,X.width,X.height,K.depth,0,ce,P,X.data);y.layerUpdates.size>0&&y.clearLayerUpdates()}else{oe&&le&&t.texStorage2D(n.TEXTURE_2D,$e,Q,he[0].width,he[0].height);for(let re=0,Ce=he.length;re<Ce;re++)X=he[re],y.format!==tn?ce!==null?oe?Ee&&t.compressedTexSubImage2D(n.TEXTURE_2D,re,0,0,X.width,X.height,ce,X.data):t.compressedTexImage2D(n.TEXTURE_2D,re,Q,X.width,X.height,0,X.data):Le("WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):oe?Ee&&t.texSubImage2D(n.TEXTURE_2D,re,0,0,X.width,X.height,ce,P,X.data):t.texImage2D(n.TEXTURE_2D,re,Q,X.width,X.height,0,ce,P,X.data)}else if(y.isDataArrayTexture)if(oe){if(le&&t.texStorage3D(n.TEXTURE_2D_ARRAY,$e,Q,K.width,K.height,K.depth),Ee)if(y.layerUpdates.size>0){let re=Xc(K.width,K.height,y.format,y.type);for(let Ce of y.layerUpdates){let We=K.data.subarray(Ce*re/K.data.BYTES_PER_ELEMENT,(Ce+1)*re/K.data.BYTES_PER_ELEMENT);t.texSubImage3D(n.TEXTURE_2D_ARRAY,0,0,0,Ce,K.width,K.height,1,ce,P,We)}y.clearLayerUpdates()}else t.texSubImage3D(n.TEXTURE_2D_ARRAY,0,0,0,0,K.width,K.height,K.depth,ce,P,K.data)}else t.texImage3D(n.TEXTURE_2D_ARRAY,0,Q,K.width,K.height,K.depth,0,ce,P,K.data);else if(y.isData3DTexture)oe?(le&&t.texStorage3D(n.TEXTURE_3D,$e,Q,K.width,K.height,K.depth),Ee&&t.texSubImage3D(n.TEXTURE_3D,0,0,0,0,K.width,K.height,K.depth,ce,P,K.data)):t.texImage3D(n.TEXTURE_3D,0,Q,K.width,K.height,K.depth,0,ce,P,K.data);else if(y.isFramebufferTexture){if(le)if(oe)t.texStorage2D(n.TEXTURE_2D,$e,Q,K.width,K.height);else{let re=K.width,Ce=K.height;for(let We=0;We<$e;We++)t.texImage2D(n.TEXTURE_2D,We,Q,re,Ce,0,ce,P,null),re>>=1,Ce>>=1}}else if(y.isHTMLTexture){if("texElementImage2D"in n){let re=n.canvas;if(re.hasAttribute("layoutsubtree")||re.setAttribute("layoutsubtree","true"),K.parentNode!==re){re.appendChild(K),d.add(y),re.onpaint=Ce=>{let We=Ce.changedElements;for(let me of d)We.includes(me.image)&&(me.needsUpdate=!0)},re.requestPaint();return}if(n.texElementImage2D.length===3)n.texElementImage2D(n.TEXTURE_2D,n.RGBA8,K);else{let We=n.RGBA,me=n.RGBA,ot=n.UNSIGNED_BYTE;n.texElementImage2D(n.TEXTURE_2D,0,We,me,ot,K)}n.texParameteri(n.TEXTURE_2D,n.TEXTURE_MIN_FILTER,n.LINEAR),n.texParameteri(n.TEXTURE_2D,n.TEXTURE_WRAP_S,n.CLAMP_TO_EDGE),n.texParameteri(n.TEXTURE_2D,n.TEXTURE_WRAP_T,n.CLAMP_TO_EDGE)}}else if(he.length>0){if(oe&&le){let re=Fe(he[0]);t.texStorage2D(n.TEXTURE_2D,$e,Q,re.width,re.height)}for(let re=0,Ce=he.length;re<Ce;re++)X=he[re],oe?Ee&&t.texSubImage2D(n.TEXTURE_2D,re,0,0,ce,P,X):t.texImage2D(n.TEXTURE_2D,re,Q,ce,P,X);y.generateMipmaps=!1}else if(oe){if(le){let re=Fe(K);t.texStorage2D(n.TEXTURE_2D,$e,Q,re.width,re.height)}Ee&&t.texSubImage2D(n.TEXTURE_2D,0,0,0,ce,P,K)}else t.texImage2D(n.TEXTURE_2D,0,Q,ce,P,K);R(y)&&y.mipmapsAutoUpdate===!0&&T(se),de.__version=ae.version,y.onUpdate&&y.onUpdate(y)}C.__version=y.version}function Jt(C,y,B){if(y.image.length!==6)return;let se=ct(C,y),ee=y.source;t.bindTexture(n.TEXTURE_CUBE_MAP,C.__webglTexture,n.TEXTURE0+B);let ae=i.get(ee);if(ee.version!==ae.__version||se===!0){t.activeTexture(n.TEXTURE0+B);let de=Ke.getPrimaries(Ke.workingColorSpace),j=y.colorSpace===li?null:Ke.getPrimaries(y.colorSpace),K=y.colorSpace===li||de===j?n.NONE:n.BROWSER_DEFAULT_WEBGL;t.pixelStorei(n.UNPACK_FLIP_Y_WEBGL,y.flipY),t.pixelStorei(n.UNPACK_PREMULTIPLY_ALPHA_WEBGL,y.premultiplyAlpha),t.pixelStorei(n.UNPACK_ALIGNMENT,y.unpackAlignment),t.pixelStorei(n.UNPACK_COLORSPACE_CONVERSION_WEBGL,K);let ce=y.isCompressedTexture||y.image[0].isCompressedTexture,P=y.image[0]&&y.image[0].isDataTexture,Q=[];for(let me=0;me<6;me++)!ce&&!P?Q[me]=S(y.image[me],!0,s.maxCubemapSize):Q[me]=P?y.image[me].image:y.image[me],Q[me]=Pe(y,Q[me]);let X=Q[0],he=r.convert(y.format,y.colorSpace),oe=r.convert(y.type),le=E(y.internalFormat,he,oe,y.normalized,y.colorSpace),Ee=y.isVideoTexture!==!0,$e=ae.__version===void 0||se===!0,re=ee.dataReady,Ce=A(y,X);rt(n.TEXTURE_CUBE_MAP,y);let We;if(y.isDepthTexture){if(le=_(y.format===ai,y.type),$e)if(Ee)t.texStorage2D(n.TEXTURE_CUBE_MAP,1,le,X.width,X.height);else for(let me=0;me<6;me++)t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,0,le,X.width,X.height,0,he,oe,null)}else if(ce){Ee&&$e&&t.texStorage2D(n.TEXTURE_CUBE_MAP,Ce,le,X.width,X.height);for(let me=0;me<6;me++){We=Q[me].mipmaps;for(let ot=0;ot<We.length;ot++){let Lt=We[ot];y.format!==tn?he!==null?Ee?re&&t.compressedTexSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,ot,0,0,Lt.width,Lt.height,he,Lt.data):t.compressedTexImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,ot,le,Lt.width,Lt.height,0,Lt.data):Le("WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):Ee?re&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,ot,0,0,Lt.width,Lt.height,he,oe,Lt.data):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,ot,le,Lt.width,Lt.height,0,he,oe,Lt.data)}}}else{if(We=y.mipmaps,Ee&&$e){We.length>0&&Ce++;let me=Fe(Q[0]);t.texStorage2D(n.TEXTURE_CUBE_MAP,Ce,le,me.width,me.height)}for(let me=0;me<6;me++)if(P){Ee?re&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,0,0,0,Q[me].width,Q[me].height,he,oe,Q[me].data):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,0,le,Q[me].width,Q[me].height,0,he,oe,Q[me].data);for(let ot=0;ot<We.length;ot++){let di=We[ot].image[me].image;Ee?re&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,ot+1,0,0,di.width,di.height,he,oe,di.data):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,ot+1,le,di.width,di.height,0,he,oe,di.data)}}else{Ee?re&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,0,0,0,he,oe,Q[me]):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,0,le,he,oe,Q[me]);for(let ot=0;ot<We.length;ot++){let Lt=We[ot];Ee?re&&t.texSubImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,ot+1,0,0,he,oe,Lt.image[me]):t.texImage2D(n.TEXTURE_CUBE_MAP_POSITIVE_X+me,ot+1,le,he,oe,Lt.image[me])}}}R(y)&&y.mipmapsAutoUpdate===!0&&T(n.TEXTURE_CUBE_MAP),ae.__version=ee.version,y.onUpdate&&y.onUpdate(y)}C.__version=y.version}function gt(C,y,B,se,ee,ae){let de=r.convert(B.format,B.colorSpace),j=r.convert(B.type),K=E(B.internalFormat,de,j,B.normalized,B.colorSpace),ce=i.get(y),P=i.get(B);if(P.__renderTarget=y,!ce.__hasExternalTextures){let Q=Math.max(1,y.width>>ae),X=Math.max(1,y.height>>ae);ee===n.TEXTURE_3D||ee===n.TEXTURE_2D_ARRAY?t.texImage3D(ee,ae,K,Q,X,y.depth,0,de,j,null):t.texImage2D(ee,ae,K,Q,X,0,de,j,null)}t.bindFramebuffer(n.FRAMEBUFFER,C),pe(y)?a.framebufferTexture2DMultisampleEXT(n.FRAMEBUFFER,se,ee,P.__webglTexture,0,mt(y)):(ee===n.TEXTURE_2D||ee>=n.TEXTURE_CUBE_MAP_POSITIVE_X&&ee<=n.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&n.framebufferTexture2D(n.FRAMEBUFFER,se,ee,P.__webglTexture,ae),t.bindFramebuffer(n.FRAMEBUFFER,null)}function kn(C,y,B){if(n.bindRenderbuffer(n.RENDERBUFFER,C),y.depthBuffer){let se=y.depthTexture,ee=se&&se.isDepthTexture?se.type:null,ae=_(y.stencilBuffer,ee),de=y.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT;pe(y)?a.renderbufferStorageMultisampleEXT(n.RENDERBUFFER,mt(y),ae,y.width,y.height):B?n.renderbufferStorageMultisample(n.RENDERBUFFER,mt(y),ae,y.width,y.height):n.renderbufferStorage(n.RENDERBUFFER,ae,y.width,y.height),n.framebufferRenderbuffer(n.FRAMEBUFFER,de,n.RENDERBUFFER,C)}else{let se=y.textures;for(let ee=0;ee<se.length;ee++){let ae=se[ee],de=r.convert(ae.format,ae.colorSpace),j=r.convert(ae.type),K=E(ae.internalFormat,de,j,ae.normalized,ae.colorSpace);pe(y)?a.renderbufferStorageMultisampleEXT(n.RENDERBUFFER,mt(y),K,y.width,y.height):B?n.renderbufferStorageMultisample(n.RENDERBUFFER,mt(y),K,y.width,y.height):n.renderbufferStorage(n.RENDERBUFFER,K,y.width,y.height)}}n.bindRenderbuffer(n.RENDERBUFFER,null)}function It(C,y,B){let se=y.isWebGLCubeRenderTarget===!0;if(t.bindFramebuffer(n.FRAMEBUFFER,C),!(y.depthTexture&&y.depthTexture.isDepthTexture))throw new Error("THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.");let ee=i.get(y.depthTexture);ee.__renderTarget=y;let ae=se?y.depthTexture.image[0]:y.depthTexture.image;(!ee.__webglTexture||ae.width!==y.width||ae.height!==y.height)&&(ae.width=y.width,ae.height=y.height,y.depthTexture.needsUpdate=!0),se?ve(y.depthTexture,0):_e(y.depthTexture,0);let de=ee.__webglTexture,j=mt(y),K=se?n.TEXTURE_CUBE_MAP_POSITIVE_X+B:n.TEXTURE_2D,ce=y.depthTexture.format===ai?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT;if(y.depthTexture.format===ii)pe(y)?a.framebufferTexture2DMultisampleEXT(n.FRAMEBUFFER,ce,K,de,0,j):n.framebufferTexture2D(n.FRAMEBUFFER,ce,K,de,0);else if(y.depthTexture.format===ai)pe(y)?a.framebufferTexture2DMultisampleEXT(n.FRAMEBUFFER,ce,K,de,0,j):n.framebufferTexture2D(n.FRAMEBUFFER,ce,K,de,0);else throw new Error("THREE.WebGLTextures: Unknown depthTexture format.")}function fn(C){let y=i.get(C),B=C.isWebGLCubeRenderTarget===!0;if(y.__boundDepthTexture!==C.depthTexture){let se=C.depthTexture;if(y.__depthDisposeCallback&&y.__depthDisposeCallback(),se){let ee=()=>{delete y.__boundDepthTexture,delete y.__depthDisposeCallback,se.removeEventListener("dispose",ee)};se.addEventListener("dispose",ee),y.__depthDisposeCallback=ee}y.__boundDepthTexture=se}if(C.depthTexture&&!y.__autoAllocateDepthBuffer)if(B)for(let se=0;se<6;se++)It(y.__webglFramebuffer[se],C,se);else C.texture.mipmaps.length>0?It(y.__webglFramebuffer[0],C,0):It(y.__webglFramebuffer,C,0);else if(B){y.__webglDepthbuffer=[];for(let se=0;se<6;se++)if(t.bindFramebuffer(n.FRAMEBUFFER,y.__webglFramebuffer[se]),y.__webglDepthbuffer[se]===void 0)y.__webglDepthbuffer[se]=n.createRenderbuffer(),kn(y.__webglDepthbuffer[se],C,!1);else{let ee=C.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT,ae=y.__webglDepthbuffer[se];n.bindRenderbuffer(n.RENDERBUFFER,ae),n.framebufferRenderbuffer(n.FRAMEBUFFER,ee,n.RENDERBUFFER,ae)}}else if(C.texture.mipmaps.length>0?t.bindFramebuffer(n.FRAMEBUFFER,y.__webglFramebuffer[0]):t.bindFramebuffer(n.FRAMEBUFFER,y.__webglFramebuffer),y.__webglDepthbuffer===void 0)y.__webglDepthbuffer=n.createRenderbuffer(),kn(y.__webglDepthbuffer,C,!1);else{let ee=C.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT,ae=y.__webglDepthbuffer;n.bindRenderbuffer(n.RENDERBUFFER,ae),n.framebufferRenderbuffer(n.FRAMEBUFFER,ee,n.RENDERBUFFER,ae)}t.bindFramebuffer(n.FRAMEBUFFER,null)}function pn(C,y,B){let se=i.get(C);y!==void 0&&gt(se.__webglFramebuffer,C,C.texture,n.COLOR_ATTACHMENT0,n.TEXTURE_2D,0),B!==void 0&&fn(C)}function mn(C){let y=C.texture,B=i.get(C),se=i.get(y);C.addEventListener("dispose",V),F(C);let ee=C.textures,ae=C.isWebGLCubeRenderTarget===!0,de=ee.length>1;if(de||(se.__webglTexture===void 0&&(se.__webglTexture=n.createTexture()),se.__version=y.version,o.memory.textures++),ae){B.__webglFramebuffer=[];for(let j=0;j<6;j++)if(y.mipmaps.length>0){B.__webglFramebuffer[j]=[];for(let K=0;K<y.mipmaps.length;K++)B.__webglFramebuffer[j][K]=n.createFramebuffer()}else B.__webglFramebuffer[j]=n.createFramebuffer()}else{if(y.mipmaps.length>0){B.__webglFramebuffer=[];for(let j=0;j<y.mipmaps.length;j++)B.__webglFramebuffer[j]=n.createFramebuffer()}else B.__webglFramebuffer=n.createFramebuffer();if(de)for(let j=0,K=ee.length;j<K;j++){let ce=i.get(ee[j]);ce.__webglTexture===void 0&&(ce.__webglTexture=n.createTexture(),o.memory.textures++)}if(C.samples>0&&pe(C)===!1){B.__webglMultisampledFramebuffer=n.createFramebuffer(),B.__webglColorRenderbuffer=[],t.bindFramebuffer(n.FRAMEBUFFER,B.__webglMultisampledFramebuffer);for(let j=0;j<ee.length;j++){let K=ee[j];B.__webglColorRenderbuffer[j]=n.createRenderbuffer(),n.bindRenderbuffer(n.RENDERBUFFER,B.__webglColorRenderbuffer[j]);let ce=r.convert(K.format,K.colorSpace),P=r.convert(K.type),Q=E(K.internalFormat,ce,P,K.normalized,K.colorSpace,C.isXRRenderTarget===!0),X=mt(C);n.renderbufferStorageMultisample(n.RENDERBUFFER,X,Q,C.width,C.height),n.framebufferRenderbuffer(n.FRAMEBUFFER,n.COLOR_ATTACHMENT0+j,n.RENDERBUFFER,B.__webglColorRenderbuffer[j])}n.bindRenderbuffer(n.RENDERBUFFER,null),C.depthBuffer&&(B.__webglDepthRenderbuffer=n.createRenderbuffer(),kn(B.__webglDepthRenderbuffer,C,!0)),t.bindFramebuffer(n.FRAMEBUFFER,null)}}if(ae){t.bindTexture(n.TEXTURE_CUBE_MAP,se.__webglTexture),rt(n.TEXTURE_CUBE_MAP,y);for(let j=0;j<6;j++)if(y.mipmaps.length>0)for(let K=0;K<y.mipmaps.length;K++)gt(B.__webglFramebuffer[j][K],C,y,n.COLOR_ATTACHMENT0,n.TEXTURE_CUBE_MAP_POSITIVE_X+j,K);else gt(B.__webglFramebuffer[j],C,y,n.COLOR_ATTACHMENT0,n.TEXTURE_CUBE_MAP_POSITIVE_X+j,0);R(y)?T(n.TEXTURE_CUBE_MAP):y.mipmaps.length>0&&n.texParameteri(n.TEXTURE_CUBE_MAP,n.TEXTURE_MAX_LEVEL,y.mipmaps.length-1),t.unbindTexture()}else if(de){for(let j=0,K=ee.length;j<K;j++){let ce=ee[j],P=i.get(ce),Q=n.TEXTURE_2D;(C.isWebGL3DRenderTarget||C.isWebGLArrayRenderTarget)&&(Q=C.isWebGL3DRenderTarget?n.TEXTURE_3D:n.TEXTURE_2D_ARRAY),t.bindTexture(Q,P.__webglTexture),rt(Q,ce),gt(B.__webglFramebuffer,C,ce,n.COLOR_ATTACHMENT0+j,Q,0),R(ce)&&T(Q)}t.unbindTexture()}else{let j=n.TEXTURE_2D;if((C.isWebGL3DRenderTarget||C.isWebGLArrayRenderTarget)&&(j=C.isWebGL3DRenderTarget?n.TEXTURE_3D:n.TEXTURE_2D_ARRAY),t.bindTexture(j,se.__webglTexture),rt(j,y),y.mipmaps.length>0)for(let K=0;K<y.mipmaps.length;K++)gt(B.__webglFramebuffer[K],C,y,n.COLOR_ATTACHMENT0,j,K);else gt(B.__webglFramebuffer,C,y,n.COLOR_ATTACHMENT0,j,0);R(y)?T(j):y.mipmaps.length>0&&n.texParameteri(j,n.TEXTURE_MAX_LEVEL,y.mipmaps.length-1),t.unbindTexture()}C.depthBuffer&&fn(C)}function k(C){let y=C.textures;for(let B=0,se=y.length;B<se;B++){let ee=y[B];if(R(ee)&&ee.mipmapsAutoUpdate===!0){let ae=M(C),de=i.get(ee).__webglTexture;t.bindTexture(ae,de),T(ae),t.unbindTexture()}}}let gn=[];function pt(C){if(C.samples>0){if(pe(C)===!1){let y=C.textures,B=C.width,se=C.height,ee=n.COLOR_BUFFER_BIT,ae=C.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT,de=i.get(C),j=y.length>1;if(j)for(let ce=0;ce<y.length;ce++)t.bindFramebuffer(n.FRAMEBUFFER,de.__webglMultisampledFramebuffer),n.framebufferRenderbuffer(n.FRAMEBUFFER,n.COLOR_ATTACHMENT0+ce,n.RENDERBUFFER,null),t.bindFramebuffer(n.FRAMEBUFFER,de.__webglFramebuffer),n.framebufferTexture2D(n.DRAW_FRAMEBUFFER,n.COLOR_ATTACHMENT0+ce,n.TEXTURE_2D,null,0);t.bindFramebuffer(n.READ_FRAMEBUFFER,de.__webglMultisampledFramebuffer),C.texture.mipmaps.length>0?t.bindFramebuffer(n.DRAW_FRAMEBUFFER,de.__webglFramebuffer[0]):t.bindFramebuffer(n.DRAW_FRAMEBUFFER,de.__webglFramebuffer);for(let ce=0;ce<y.length;ce++){if(C.resolveDepthBuffer&&(C.depthBuffer&&(ee|=n.DEPTH_BUFFER_BIT),C.stencilBuffer&&C.resolveStencilBuffer&&(ee|=n.STENCIL_BUFFER_BIT)),j){n.framebufferRenderbuffer(n.READ_FRAMEBUFFER,n.COLOR_ATTACHMENT0,n.RENDERBUFFER,de.__webglColorRenderbuffer[ce]);let P=i.get(y[ce]).__webglTexture;n.framebufferTexture2D(n.DRAW_FRAMEBUFFER,n.COLOR_ATTACHMENT0,n.TEXTURE_2D,P,0)}n.blitFramebuffer(0,0,B,se,0,0,B,se,ee,n.NEAREST),l===!0&&(gn.length=0,gn.push(n.COLOR_ATTACHMENT0+ce),C.depthBuffer&&C.storeMultisampledDepthBuffer===!1&&gn.push(ae),n.invalidateFramebuffer(n.READ_FRAMEBUFFER,gn))}if(t.bindFramebuffer(n.READ_FRAMEBUFFER,null),t.bindFramebuffer(n.DRAW_FRAMEBUFFER,null),j)for(let ce=0;ce<y.length;ce++){t.bindFramebuffer(n.FRAMEBUFFER,de.__webglMultisampledFramebuffer),n.framebufferRenderbuffer(n.FRAMEBUFFER,n.COLOR_ATTACHMENT0+ce,n.RENDERBUFFER,de.__webglColorRenderbuffer[ce]);let P=i.get(y[ce]).__webglTexture;t.bindFramebuffer(n.FRAMEBUFFER,de.__webglFramebuffer),n.framebufferTexture2D(n.DRAW_FRAMEBUFFER,n.COLOR_ATTACHMENT0+ce,n.TEXTURE_2D,P,0)}t.bindFramebuffer(n.DRAW_FRAMEBUFFER,de.__webglMultisampledFramebuffer)}else if(C.depthBuffer&&C.storeMultisampledDepthBuffer===!1&&l){let y=C.stencilBuffer?n.DEPTH_STENCIL_ATTACHMENT:n.DEPTH_ATTACHMENT;n.invalidateFramebuffer(n.DRAW_FRAMEBUFFER,[y])}}}function mt(C){return Math.min(s.maxSamples,C.samples)}function pe(C){let y=i.get(C);return C.samples>0&&e.has("WEBGL_multisampled_render_to_texture")===!0&&y.__useRenderToTexture!==!1}function Tt(C){let y=o.render.frame;h.get(C)!==y&&(h.set(C,y),C.update())}function Pe(C,y){let B=C.colorSpace,se=C.format,ee=C.type;return C.isCompressedTexture===!0||C.isVideoTexture===!0||B!==fr&&B!==li&&(Ke.getTransfer(B)===st?(se!==tn||ee!==Ht)&&Le("WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):Oe("WebGLTextures: Unsupported texture color space:",B)),y}function Fe(C){return typeof HTMLImageElement<"u"&&C instanceof HTMLImageElement?(c.width=C.naturalWidth||C.width,c.height=C.naturalHeight||C.height):typeof VideoFrame<"u"&&C instanceof VideoFrame?(c.width=C.displayWidth,c.height=C.displayHeight):(c.width=C.width,c.height=C.height),c}this.allocateTextureUnit=ze,this.resetTextureUnits=te,this.getTextureUnits=ne,this.setTextureUnits=Ae,this.setTexture2D=_e,this.setTexture2DArray=Se,this.setTexture3D=Re,this.setTextureCube=ve,this.rebindTextures=pn,this.setupRenderTarget=mn,this.updateRenderTargetMipmap=k,this.updateMultisampleRenderTarget=pt,this.setupDepthRenderbuffer=fn,this.setupFrameBufferTexture=gt,this.useMultisampledRTT=pe,this.dispose=H}function Jx(n,e){function t(i,s=li){let r,o=Ke.getTransfer(s);if(i===Ht)return n.UNSIGNED_BYTE;if(i===xa)return n.UNSIGNED_SHORT_4_4_4_4;if(i===ya)return n.UNSIGNED_SHORT_5_5_5_1;if(i===Pc)return n.UNSIGNED_INT_5_9_9_9_REV;if(i===Ic)return n.UNSIGNED_INT_10F_11F_11F_REV;if(i===Cc)return n.BYTE;if(i===Rc)return n.SHORT;if(i===Ws)return n.UNSIGNED_SHORT;if(i===va)return n.INT;if(i===In)return n.UNSIGNED_INT;if(i===Ln)return n.FLOAT;if(i===Dn)return n.HALF_FLOAT;if(i===Lc)return n.ALPHA;if(i===Dc)return n.RGB;if(i===tn)return n.RGBA;if(i===ii)return n.DEPTH_COMPONENT;if(i===ai)return n.DEPTH_STENCIL;if(i===Nc)return n.RED;if(i===ba)return n.RED_INTEGER;if(i===Di)return n.RG;if(i===Sa)return n.RG_INTEGER;if(i===wa)return n.RGBA_INTEGER;if(i===Pr||i===Ir||i===Lr||i===Dr)if(o===st)if(r=e.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(i===Pr)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(i===Ir)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(i===Lr)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(i===Dr)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=e.get("WEBGL_compressed_texture_s3tc"),r!==null){if(i===Pr)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(i===Ir)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(i===Lr)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(i===Dr)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(i===Ma||i===Aa||i===Ta||i===Ea)if(r=e.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(i===Ma)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(i===Aa)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(i===Ta)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(i===Ea)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(i===Ca||i===Ra||i===Pa||i===Ia||i===La||i===Nr||i===Da)if(r=e.get("WEBGL_compressed_texture_etc"),r!==null){if(i===Ca||i===Ra)return o===st?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(i===Pa)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC;if(i===Ia)return r.COMPRESSED_R11_EAC;if(i===La)return r.COMPRESSED_SIGNED_R11_EAC;if(i===Nr)return r.COMPRESSED_RG11_EAC;if(i===Da)return r.COMPRESSED_SIGNED_RG11_EAC}else return null;if(i===Na||i===ka||i===Oa||i===Ua||i===Fa||i===za||i===Ba||i===Va||i===Ga||i===Ha||i===Wa||i===$a||i===qa||i===Xa)if(r=e.get("WEBGL_compressed_texture_astc"),r!==null){if(i===Na)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(i===ka)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(i===Oa)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(i===Ua)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(i===Fa)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(i===za)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(i===Ba)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(i===Va)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(i===Ga)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(i===Ha)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(i===Wa)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(i===$a)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(i===qa)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(i===Xa)return o===st?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(i===Ya||i===Za||i===ja)if(r=e.get("EXT_texture_compression_bptc"),r!==null){if(i===Ya)return o===st?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(i===Za)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(i===ja)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(i===Ka||i===Ja||i===kr||i===Qa)if(r=e.get("EXT_texture_compression_rgtc"),r!==null){if(i===Ka)return r.COMPRESSED_RED_RGTC1_EXT;if(i===Ja)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(i===kr)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(i===Qa)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return i===ss?n.UNSIGNED_INT_24_8:n[i]!==void 0?n[i]:null}return{convert:t}}var Qx=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,ey=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,nh=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let i=new wr(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=i}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,i=new Vn({vertexShader:Qx,fragmentShader:ey,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new Zt(new Mr(20,20),i)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},ih=class extends Rn{constructor(e,t){super();let i=this,s=null,r=1,o=null,a="local-floor",l=1,c=null,h=null,d=null,u=null,f=null,g=null,w=typeof XRWebGLBinding<"u",p=new nh,m={},S=t.getContextAttributes(),R=null,T=null,M=[],E=[],_=new De,A=null,F=null,N=new qt;N.viewport=new vt;let U=new qt;U.viewport=new vt;let V=[N,U],q=new pa,I=null,H=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(J){let _e=M[J];return _e===void 0&&(_e=new Ns,M[J]=_e),_e.getTargetRaySpace()},this.getControllerGrip=function(J){let _e=M[J];return _e===void 0&&(_e=new Ns,M[J]=_e),_e.getGripSpace()},this.getHand=function(J){let _e=M[J];return _e===void 0&&(_e=new Ns,M[J]=_e),_e.getHandSpace()};function Z(J){let _e=E.indexOf(J.inputSource);if(_e===-1)return;let Se=M[_e];Se!==void 0&&(Se.update(J.inputSource,J.frame,c||o),Se.dispatchEvent({type:J.type,data:J.inputSource}))}function W(){s.removeEventListener("select",Z),s.removeEventListener("selectstart",Z),s.removeEventListener("selectend",Z),s.removeEventListener("squeeze",Z),s.removeEventListener("squeezestart",Z),s.removeEventListener("squeezeend",Z),s.removeEventListener("end",W),s.removeEventListener("inputsourceschange",ie);for(let J=0;J<M.length;J++){let _e=E[J];_e!==null&&(E[J]=null,M[J].disconnect(_e))}I=null,H=null,p.reset();for(let J in m)delete m[J];if(e.setRenderTarget(R),f=null,u=null,d=null,s=null,T=null,ze.stop(),i.isPresenting=!1,e.setPixelRatio(A),e.setSize(_.width,_.height,!1),F!==null){let J=F.camera;J.fov=F.fov,J.zoom=F.zoom,J.updateProjectionMatrix(),F=null}i.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(J){r=J,i.isPresenting===!0&&Le("WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(J){a=J,i.isPresenting===!0&&Le("WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||o},this.setReferenceSpace=function(J){c=J},this.getBaseLayer=function(){return u!==null?u:f},this.getBinding=function(){return d===null&&w&&(d=new XRWebGLBinding(s,t)),d},this.getFrame=function(){return g},this.getSession=function(){return s},this.setSession=async function(J){if(s=J,s!==null){if(R=e.getRenderTarget(),s.addEventListener("select",Z),s.addEventListener("selectstart",Z),s.addEventListener("selectend",Z),s.addEventListener("squeeze",Z),s.addEventListener("squeezestart",Z),s.addEventListener("squeezeend",Z),s.addEventListener("end",W),s.addEventListener("inputsourceschange",ie),S.xrCompatible!==!0&&await t.makeXRCompatible(),A=e.getPixelRatio(),e.getSize(_),w&&"createProjectionLayer"in XRWebGLBinding.prototype){let Se=null,Re=null,ve=null;S.depth&&(ve=S.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,Se=S.stencil?ai:ii,Re=S.stencil?ss:In);let Ge={colorFormat:t.RGBA8,depthFormat:ve,scaleFactor:r};d=this.getBinding(),u=d.createProjectionLayer(Ge),s.updateRenderState({layers:[u]}),e.setPixelRatio(1),e.setSize(u.textureWidth,u.textureHeight,!1),T=new Yt(u.textureWidth,u.textureHeight,{format:tn,type:Ht,depthTexture:new ri(u.textureWidth,u.textureHeight,Re,void 0,void 0,void 0,void 0,void 0,void 0,Se),stencilBuffer:S.stencil,colorSpace:e.outputColorSpace,samples:S.antialias?4:0,resolveDepthBuffer:u.ignoreDepthValues===!1,resolveStencilBuffer:u.ignoreDepthValues===!1,storeMultisampledDepthBuffer:u.ignoreDepthValues===!1,storeMultisampledStencilBuffer:u.ignoreDepthValues===!1})}else{let Se={antialias:S.antialias,alpha:!0,depth:S.depth,stencil:S.stencil,framebufferScaleFactor:r};f=new XRWebGLLayer(s,t,Se),s.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),T=new Yt(f.framebufferWidth,f.framebufferHeight,{format:tn,type:Ht,colorSpace:e.outputColorSpace,stencilBuffer:S.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}T.isXRRenderTarget=!0,this.setFoveation(l),c=null,o=await s.requestReferenceSpace(a),ze.setContext(s),ze.start(),i.isPresenting=!0,i.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return p.getDepthTexture()};function ie(J){for(let _e=0;_e<J.removed.length;_e++){let Se=J.removed[_e],Re=E.indexOf(Se);Re>=0&&(E[Re]=null,M[Re].disconnect(Se))}for(let _e=0;_e<J.added.length;_e++){let Se=J.added[_e],Re=E.indexOf(Se);if(Re===-1){for(let Ge=0;Ge<M.length;Ge++)if(Ge>=E.length){E.push(Se),Re=Ge;break}else if(E[Ge]===null){E[Ge]=Se,Re=Ge;break}if(Re===-1)break}let ve=M[Re];ve&&ve.connect(Se)}}function Y(J,_e){_e===null?J.matrixWorld.copy(J.matrix):J.matrixWorld.multiplyMatrices(_e.matrixWorld,J.matrix),J.matrixWorldInverse.copy(J.matrixWorld).invert()}this.updateCamera=function(J){if(s===null)return;let _e=J.near,Se=J.far;p.texture!==null&&(p.depthNear>0&&(_e=p.depthNear),p.depthFar>0&&(Se=p.depthFar)),q.near=U.near=N.near=_e,q.far=U.far=N.far=Se,(I!==q.near||H!==q.far)&&(s.updateRenderState({depthNear:q.near,depthFar:q.far}),I=q.near,H=q.far),q.layers.mask=J.layers.mask|6,N.layers.mask=q.layers.mask&-5,U.layers.mask=q.layers.mask&-3;let Re=J.parent,ve=q.cameras;Y(q,Re);for(let Ge=0;Ge<ve.length;Ge++)Y(ve[Ge],Re);q.projectionMatrix.copy(N.projectionMatrix),q.projectionMatrixInverse.copy(N.projectionMatrixInverse),F===null&&J.isPerspectiveCamera&&(F={camera:J,fov:J.fov,zoom:J.zoom}),te(J,q,Re)};function te(J,_e,Se){Se===null?J.matrix.copy(_e.matrixWorld):(J.matrix.copy(Se.matrixWorld),J.matrix.invert(),J.matrix.multiply(_e.matrixWorld)),J.matrix.decompose(J.position,J.quaternion,J.scale),J.updateMatrixWorld(!0),J.projectionMatrix.copy(_e.projectionMatrix),J.projectionMatrixInverse.copy(_e.projectionMatrixInverse),J.isPerspectiveCamera&&(J.fov=Ls*2*Math.atan(1/J.projectionMatrix.elements[5]),J.zoom=1)}this.getCamera=function(){return q},this.getFoveation=function(){if(!(u===null&&f===null))return l},this.setFoveation=function(J){l=J,u!==null&&(u.fixedFoveation=J),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=J)},this.hasDepthSensing=function(){return p.texture!==null},this.getDepthSensingMesh=function(){return p.getMesh(q)},this.getCameraTexture=function(J){return m[J]};let ne=null;function Ae(J,_e){if(h=_e.getViewerPose(c||o),g=_e,h!==null){let Se=h.views;f!==null&&(e.setRenderTargetFramebuffer(T,f.framebuffer),e.setRenderTarget(T));let Re=!1;Se.length!==q.cameras.length&&(q.cameras.length=0,Re=!0);for(let Ne=0;Ne<Se.length;Ne++){let rt=Se[Ne],ct=null;if(f!==null)ct=f.getViewport(rt);else{let Ot=d.getViewSubImage(u,rt);ct=Ot.viewport,Ne===0&&(e.setRenderTargetTextures(T,Ot.colorTexture,Ot.depthStencilTexture),e.setRenderTarget(T))}let Ye=V[Ne];Ye===void 0&&(Ye=new qt,Ye.layers.enable(Ne),Ye.viewport=new vt,V[Ne]=Ye),Ye.matrix.fromArray(rt.transform.matrix),Ye.matrix.decompose(Ye.position,Ye.quaternion,Ye.scale),Ye.projectionMatrix.fromArray(rt.projectionMatrix),Ye.projectionMatrixInverse.copy(Ye.projectionMatrix).invert(),Ye.viewport.set(ct.x,ct.y,ct.width,ct.height),Ne===0&&(q.matrix.copy(Ye.matrix),q.matrix.decompose(q.position,q.quaternion,q.scale)),Re===!0&&q.cameras.push(Ye)}let ve=s.enabledFeatures;if(ve&&ve.includes("depth-sensing")&&s.depthUsage=="gpu-optimized"&&w){d=i.getBinding();let Ne=d.getDepthInformation(Se[0]);Ne&&Ne.isValid&&Ne.texture&&p.init(Ne,s.renderState)}if(ve&&ve.includes("camera-access")&&w){e.state.unbindTexture(),d=i.getBinding();for(let Ne=0;Ne<Se.length;Ne++){let rt=Se[Ne].camera;if(rt){let ct=m[rt];ct||(ct=new wr,m[rt]=ct);let Ye=d.getCameraImage(rt);ct.sourceTexture=Ye}}}}for(let Se=0;Se<M.length;Se++){let Re=E[Se],ve=M[Se];Re!==null&&ve!==void 0&&ve.update(Re,_e,c||o)}ne&&ne(J,_e),_e.detectedPlanes&&i.dispatchEvent({type:"planesdetected",data:_e}),g=null}let ze=new Mf;ze.setAnimationLoop(Ae),this.setAnimationLoop=function(J){ne=J},this.dispose=function(){}}},ty=new ut,Nf=new Ue;Nf.set(-1,0,0,0,1,0,0,0,1);function ny(n,e){function t(p,m){p.matrixAutoUpdate===!0&&p.updateMatrix(),m.value.copy(p.matrix)}function i(p,m){m.color.getRGB(p.fogColor.value,Wc(n)),m.isFog?(p.fogNear.value=m.near,p.fogFar.value=m.far):m.isFogExp2&&(p.fogDensity.value=m.density)}function s(p,m,S,R,T){m.isNodeMaterial?m.uniformsNeedUpdate=!1:m.isMeshBasicMaterial?r(p,m):m.isMeshLambertMaterial?(r(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshToonMaterial?(r(p,m),d(p,m)):m.isMeshPhongMaterial?(r(p,m),h(p,m),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)):m.isMeshStandardMaterial?(r(p,m),u(p,m),m.isMeshPhysicalMaterial&&f(p,m,T)):m.isMeshMatcapMaterial?(r(p,m),g(p,m)):m.isMeshDepthMaterial?r(p,m):m.isMeshDistanceMaterial?(r(p,m),w(p,m)):m.isMeshNormalMaterial?r(p,m):m.isLineBasicMaterial?(o(p,m),m.isLineDashedMaterial&&a(p,m)):m.isPointsMaterial?l(p,m,S,R):m.isSpriteMaterial?c(p,m):m.isShadowMaterial?(p.color.value.copy(m.color),p.opacity.value=m.opacity):m.isShaderMaterial&&(m.uniformsNeedUpdate=!1)}function r(p,m){p.opacity.value=m.opacity,m.color&&p.diffuse.value.copy(m.color),m.emissive&&p.emissive.value.copy(m.emissive).multiplyScalar(m.emissiveIntensity),m.map&&(p.map.value=m.map,t(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.bumpMap&&(p.bumpMap.value=m.bumpMap,t(m.bumpMap,p.bumpMapTransform),p.bumpScale.value=m.bumpScale,m.side===jt&&(p.bumpScale.value*=-1)),m.normalMap&&(p.normalMap.value=m.normalMap,t(m.normalMap,p.normalMapTransform),p.normalScale.value.copy(m.normalScale),m.side===jt&&p.normalScale.value.negate()),m.displacementMap&&(p.displacementMap.value=m.displacementMap,t(m.displacementMap,p.displacementMapTransform),p.displacementScale.value=m.displacementScale,p.displacementBias.value=m.displacementBias),m.emissiveMap&&(p.emissiveMap.value=m.emissiveMap,t(m.emissiveMap,p.emissiveMapTransform)),m.specularMap&&(p.specularMap.value=m.specularMap,t(m.specularMap,p.specularMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest);let S=e.get(m),R=S.envMap,T=S.envMapRotation;R&&(p.envMap.value=R,p.envMapRotation.value.setFromMatrix4(ty.makeRotationFromEuler(T)).transpose(),R.isCubeTexture&&R.isRenderTargetTexture===!1&&p.envMapRotation.value.premultiply(Nf),p.reflectivity.value=m.reflectivity,p.ior.value=m.ior,p.refractionRatio.value=m.refractionRatio),m.lightMap&&(p.lightMap.value=m.lightMap,p.lightMapIntensity.value=m.lightMapIntensity,t(m.lightMap,p.lightMapTransform)),m.aoMap&&(p.aoMap.value=m.aoMap,p.aoMapIntensity.value=m.aoMapIntensity,t(m.aoMap,p.aoMapTransform))}function o(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,m.map&&(p.map.value=m.map,t(m.map,p.mapTransform))}function a(p,m){p.dashSize.value=m.dashSize,p.totalSize.value=m.dashSize+m.gapSize,p.scale.value=m.scale}function l(p,m,S,R){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.size.value=m.size*S,p.scale.value=R*.5,m.map&&(p.map.value=m.map,t(m.map,p.uvTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function c(p,m){p.diffuse.value.copy(m.color),p.opacity.value=m.opacity,p.rotation.value=m.rotation,m.map&&(p.map.value=m.map,t(m.map,p.mapTransform)),m.alphaMap&&(p.alphaMap.value=m.alphaMap,t(m.alphaMap,p.alphaMapTransform)),m.alphaTest>0&&(p.alphaTest.value=m.alphaTest)}function h(p,m){p.specular.value.copy(m.specular),p.shininess.value=Math.max(m.shininess,1e-4)}function d(p,m){m.gradientMap&&(p.gradientMap.value=m.gradientMap)}function u(p,m){p.metalness.value=m.metalness,m.metalnessMap&&(p.metalnessMap.value=m.metalnessMap,t(m.metalnessMap,p.metalnessMapTransform)),p.roughness.value=m.roughness,m.roughnessMap&&(p.roughnessMap.value=m.roughnessMap,t(m.roughnessMap,p.roughnessMapTransform)),m.envMap&&(p.envMapIntensity.value=m.envMapIntensity)}function f(p,m,S){p.ior.value=m.ior,m.diffuseRoughness>0&&(p.diffuseRoughness.value=m.diffuseRoughness,m.diffuseRoughnessMap&&(p.diffuseRoughnessMap.value=m.diffuseRoughnessMap,t(m.diffuseRoughnessMap,p.diffuseRoughnessMapTransform))),m.sheen>0&&(p.sheenColor.value.copy(m.sheenColor).multiplyScalar(m.sheen),p.sheenRoughness.value=m.sheenRoughness,m.sheenColorMap&&(p.sheenColorMap.value=m.sheenColorMap,t(m.sheenColorMap,p.sheenColorMapTransform)),m.sheenRoughnessMap&&(p.sheenRoughnessMap.value=m.sheenRoughnessMap,t(m.sheenRoughnessMap,p.sheenRoughnessMapTransform))),m.clearcoat>0&&(p.clearcoat.value=m.clearcoat,p.clearcoatRoughness.value=m.clearcoatRoughness,m.clearcoatMap&&(p.clearcoatMap.value=m.clearcoatMap,t(m.clearcoatMap,p.clearcoatMapTransform)),m.clearcoatRoughnessMap&&(p.clearcoatRoughnessMap.value=m.clearcoatRoughnessMap,t(m.clearcoatRoughnessMap,p.clearcoatRoughnessMapTransform)),m.clearcoatNormalMap&&(p.clearcoatNormalMap.value=m.clearcoatNormalMap,t(m.clearcoatNormalMap,p.clearcoatNormalMapTransform),p.clearcoatNormalScale.value.copy(m.clearcoatNormalScale),m.side===jt&&p.clearcoatNormalScale.value.negate())),m.dispersion>0&&(p.dispersion.value=m.dispersion),m.retroreflectivity>0&&(p.retroreflectivity.value=m.retroreflectivity),m.iridescence>0&&(p.iridescence.value=m.iridescence,p.iridescenceIOR.value=m.iridescenceIOR,p.iridescenceThicknessMinimum.value=m.iridescenceThicknessMinimum,p.iridescenceThicknessMaximum.value=m.iridescenceThicknessMaximum,m.iridescenceMap&&(p.iridescenceMap.value=m.iridescenceMap,t(m.iridescenceMap,p.iridescenceMapTransform)),m.iridescenceThicknessMap&&(p.iridescenceThicknessMap.value=m.iridescenceThicknessMap,t(m.iridescenceThicknessMap,p.iridescenceThicknessMapTransform))),m.transmission>0&&(p.transmission.value=m.transmission,p.transmissionSamplerMap.value=S.texture,p.transmissionSamplerSize.value.set(S.width,S.height),m.transmissionMap&&(p.transmissionMap.value=m.transmissionMap,t(m.transmissionMap,p.transmissionMapTransform)),p.thickness.value=m.thickness,m.thicknessMap&&(p.thicknessMap.value=m.thicknessMap,t(m.thicknessMap,p.thicknessMapTransform)),p.attenuationDistance.value=m.attenuationDistance,p.attenuationColor.value.copy(m.attenuationColor)),m.anisotropy>0&&(p.anisotropyVector.value.set(m.anisotropy*Math.cos(m.anisotropyRotation),m.anisotropy*Math.sin(m.anisotropyRotation)),m.anisotropyMap&&(p.anisotropyMap.value=m.anisotropyMap,t(m.anisotropyMap,p.anisotropyMapTransform))),p.specularIntensity.value=m.specularIntensity,p.specularColor.value.copy(m.specularColor),m.specularColorMap&&(p.specularColorMap.value=m.specularColorMap,t(m.specularColorMap,p.specularColorMapTransform)),m.specularIntensityMap&&(p.specularIntensityMap.value=m.specularIntensityMap,t(m.specularIntensityMap,p.specularIntensityMapTransform))}function g(p,m){m.matcap&&(p.matcap.value=m.matcap)}function w(p,m){let S=e.get(m).light;p.referencePosition.value.setFromMatrixPosition(S.matrixWorld),p.nearDistance.value=S.shadow.camera.near,p.farDistance.value=S.shadow.camera.far}return{refreshFogUniforms:i,refreshMaterialUniforms:s}}function iy(n,e,t,i){let s={},r={};function o(S,R){let T=R.program;i.uniformBlockBinding(S,T,s[S.id])}function a(S,R){let T=s[S.id];T===void 0&&(g(S),T=l(S),s[S.id]=T,S.addEventListener("dispose",p));let M=R.program;i.updateUBOMapping(S,M);let E=e.render.frame;r[S.id]!==E&&(c(S),r[S.id]=E)}function l(S){let R=n.createBuffer(),T=S.__size,M=S.usage;return n.bindBuffer(n.UNIFORM_BUFFER,R),n.bufferData(n.UNIFORM_BUFFER,T,M),n.bindBuffer(n.UNIFORM_BUFFER,null),R}function c(S){let R=s[S.id],T=S.uniforms,M=S.__cache;n.bindBuffer(n.UNIFORM_BUFFER,R);for(let E=0,_=T.length;E<_;E++){let A=T[E];if(Array.isArray(A))for(let F=0,N=A.length;F<N;F++)h(A[F],E,F,M);else h(A,E,0,M)}n.bindBuffer(n.UNIFORM_BUFFER,null)}function h(S,R,T,M){if(u(S,R,T,M)===!0){let E=S.__offset,_=S.value;if(Array.isArray(_)){let A=0;for(let F=0;F<_.length;F++){let N=_[F],U=w(N,!0);d(N,S.__data,A),A+=U.storage/Float32Array.BYTES_PER_ELEMENT}}else d(_,S.__data,0);n.bufferSubData(n.UNIFORM_BUFFER,E,S.__data)}}function d(S,R,T){typeof S=="number"||typeof S=="boolean"?R[T]=S:S.isMatrix3?(R[T]=S.elements[0],R[T+1]=S.elements[1],R[T+2]=S.elements[2],R[T+3]=0,R[T+4]=S.elements[3],R[T+5]=S.elements[4],R[T+6]=S.elements[5],R[T+7]=0,R[T+8]=S.elements[6],R[T+9]=S.elements[7],R[T+10]=S.elements[8],R[T+11]=0):ArrayBuffer.isView(S)?R.set(S.subarray(0,R.length-T),T):S.toArray(R,T)}function u(S,R,T,M){let E=S.value,_=R+"_"+T;if(Array.isArray(E)){M[_]===void 0&&(M[_]=[]);let A=M[_],F=!1;for(let N=0;N<E.length;N++)f(E[N],A,N)===!0&&(F=!0);return F}return f(E,M,_)}function f(S,R,T){if(R[T]===void 0)return typeof S=="number"||typeof S=="boolean"?R[T]=S:ArrayBuffer.isView(S)?R[T]=S.slice():R[T]=S.clone(),!0;{let M=R[T];if(typeof S=="number"||typeof S=="boolean"){if(M!==S)return R[T]=S,!0}else{if(ArrayBuffer.isView(S))return!0;if(M.equals(S)===!1)return M.copy(S),!0}}return!1}function g(S){let R=S.uniforms,T=0,M=16;for(let _=0,A=R.length;_<A;_++){let F=Array.isArray(R[_])?R[_]:[R[_]];for(let N=0,U=F.length;N<U;N++){let V=F[N],q=Array.isArray(V.value)?V.value:[V.value],I=Array.isArray(R[_])||Array.isArray(V.value),H=T;for(let W=0,ie=q.length;W<ie;W++){let Y=q[W],te=w(Y,I),ne=T%M,Ae=ne%te.boundary,ze=ne+Ae;T+=Ae,ze!==0&&M-ze<te.storage&&(T+=M-ze),W===0&&(H=T),T+=te.storage}let Z=V.type==="int"?Int32Array:V.type==="uint"?Uint32Array:Float32Array;V.__data=new Z((T-H)/Float32Array.BYTES_PER_ELEMENT),V.__offset=H}}let E=T%M;return E>0&&(T+=M-E),S.__size=T,S.__cache={},this}function w(S,R){let T={boundary:0,storage:0};return typeof S=="number"||typeof S=="boolean"?(T.boundary=4,T.storage=4):S.isVector2?(T.boundary=8,T.storage=8):S.isVector3||S.isColor?(T.boundary=16,T.storage=12):S.isVector4?(T.boundary=16,T.storage=16):S.isMatrix3?(T.boundary=16,T.storage=48):S.isMatrix4?(T.boundary=16,T.storage=64):S.isTexture?Le("WebGLRenderer: Texture samplers can not be part of an uniforms group."):ArrayBuffer.isView(S)?(T.boundary=16,T.storage=S.byteLength):Le("WebGLRenderer: Unsupported uniform value type.",S),R===!0&&(T.boundary=16,T.storage=Math.ceil(T.storage/16)*16),T}function p(S){let R=S.target;R.removeEventListener("dispose",p),n.deleteBuffer(s[R.id]),delete s[R.id],delete r[R.id]}function m(){for(let S in s)n.deleteBuffer(s[S]);s={},r={}}return{bind:o,update:a,dispose:m}}var sy=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),Wn=null;function ry(){return Wn===null&&(Wn=new es(sy,16,16,Di,Dn),Wn.name="DFG_LUT",Wn.minFilter=Xt,Wn.magFilter=Xt,Wn.wrapS=zn,Wn.wrapT=zn,Wn.generateMipmaps=!1,Wn.needsUpdate=!0),Wn}var il=class{constructor(e={}){let{canvas:t=qd(),context:i=null,depth:s=!0,stencil:r=!1,alpha:o=!1,antialias:a=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:h="default",failIfMajorPerformanceCaveat:d=!1,reversedDepthBuffer:u=!1,outputBufferType:f=Ht}=e;this.isWebGLRenderer=!0;let g;if(i!==null){if(typeof WebGLRenderingContext<"u"&&i instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");g=i.getContextAttributes().alpha}else g=o;let w=f,p=new Set([wa,Sa,ba]),m=new Set([Ht,In,Ws,ss,xa,ya]),S=new Uint32Array(4),R=new Int32Array(4),T={textures:[],min:[],max:[],resolution:[]},M=null,E=null,_=[],A=[],F=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=Gn,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let N=this,U=!1,V=null,q=null,I=null,H=null;this._outputColorSpace=an;let Z=0,W=0,ie=null,Y=-1,te=null,ne=new vt,Ae=new vt,ze=null,J=new Ve(0),_e=0,Se=t.width,Re=t.height,ve=1,Ge=null,bt=null,Ne=new vt(0,0,Se,Re),rt=new vt(0,0,Se,Re),ct=!1,Ye=new si,Ot=new ea,At=!1,Jt=!1,gt=new ut,kn=new O,It=new vt,fn={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},pn=!1;function mn(){return ie===null?ve:1}let k=i;function gn(b,D){return t.getContext(b,D)}let pt,mt,pe,Tt,Pe,Fe,C,y,B,se,ee,ae,de,j,K,ce,P,Q,X,he,oe,le,Ee;try{let b={alpha:!0,depth:s,stencil:r,antialias:a,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:h,failIfMajorPerformanceCaveat:d};if("setAttribute"in t&&t.setAttribute("data-engine",`three.js r${"187"}`),t.addEventListener("webglcontextlost",Ce,!1),t.addEventListener("webglcontextrestored",We,!1),t.addEventListener("webglcontextcreationerror",me,!1),k===null){let D="webgl2";if(k=gn(D,b),k===null)throw gn(D)?new Error("THREE.WebGLRenderer: Error creating WebGL context with your selected attributes."):new Error("THREE.WebGLRenderer: Error creating WebGL context.")}$e()}catch(b){throw t.removeEventListener("webglcontextlost",Ce,!1),t.removeEventListener("webglcontextrestored",We,!1),t.removeEventListener("webglcontextcreationerror",me,!1),Oe("WebGLRenderer: "+b.message),b}function $e(){pt=new gv(k),pt.init(),oe=new Jx(k,pt),mt=new rv(k,pt,e,oe),pe=new jx(k,pt),mt.reversedDepthBuffer&&u&&pe.buffers.depth.setReversed(!0),q=k.createFramebuffer(),I=k.createFramebuffer(),H=k.createFramebuffer(),Tt=new xv(k),Pe=new Ox,Fe=new Kx(k,pt,pe,Pe,mt,oe,Tt),C=new mv(N),y=new bg(k),le=new iv(k,y),B=new _v(k,y,Tt,le),se=new bv(k,B,y,le,Tt),Q=new yv(k,mt,Fe),K=new ov(Pe),ee=new kx(N,C,pt,mt,le,K),ae=new ny(N,Pe),de=new Fx,j=new Wx(pt),P=new nv(N,C,pe,se,g,l),ce=new Zx(N,se,mt),Ee=new iy(k,Tt,mt,pe),X=new sv(k,pt,Tt),he=new vv(k,pt,Tt),Tt.programs=ee.programs,N.capabilities=mt,N.extensions=pt,N.properties=Pe,N.renderLists=de,N.shadowMap=ce,N.state=pe,N.info=Tt}w!==Ht&&(F=new wv(w,t.width,t.height,a,s,r));let re=new ih(N,k);this.xr=re,this.getContext=function(){return k},this.getContextAttributes=function(){return k.getContextAttributes()},this.forceContextLoss=function(){let b=pt.get("WEBGL_lose_context");b&&b.loseContext()},this.forceContextRestore=function(){let b=pt.get("WEBGL_lose_context");b&&b.restoreContext()},this.getPixelRatio=function(){return ve},this.setPixelRatio=function(b){b!==void 0&&(ve=b,this.setSize(Se,Re,!1))},this.getSize=function(b){return b.set(Se,Re)},this.setSize=function(b,D,$=!0){if(re.isPresenting){Le("WebGLRenderer: Can't change size while VR device is presenting.");return}Se=b,Re=D,t.width=Math.floor(b*ve),t.height=Math.floor(D*ve),$===!0&&(t.style.width=b+"px",t.style.height=D+"px"),F!==null&&F.setSize(t.width,t.height),this.setViewport(0,0,b,D)},this.getDrawingBufferSize=function(b){return b.set(Se*ve,Re*ve).floor()},this.setDrawingBufferSize=function(b,D,$){Se=b,Re=D,ve=$,t.width=Math.floor(b*$),t.height=Math.floor(D*$),this.setViewport(0,0,b,D)},this.setEffects=function(b){if(w===Ht){Oe("WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.");return}if(b){for(let D=0;D<b.length;D++)if(b[D].isOutputPass===!0){Le("WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.");break}}F.setEffects(b||[])},this.getCurrentViewport=function(b){return b.copy(ne)},this.getViewport=function(b){return b.copy(Ne)},this.setViewport=function(b,D,$,z){b.isVector4?Ne.set(b.x,b.y,b.z,b.w):Ne.set(b,D,$,z),pe.viewport(ne.copy(Ne).multiplyScalar(mn()).round())},this.getScissor=function(b){return b.copy(rt)},this.setScissor=function(b,D,$,z){b.isVector4?rt.set(b.x,b.y,b.z,b.w):rt.set(b,D,$,z),pe.scissor(Ae.copy(rt).multiplyScalar(mn()).round())},this.getScissorTest=function(){return ct},this.setScissorTest=function(b){pe.setScissorTest(ct=b)},this.setOpaqueSort=function(b){Ge=b},this.setTransparentSort=function(b){bt=b},this.getClearColor=function(b){return b.copy(P.getClearColor())},this.setClearColor=function(){P.setClearColor(...arguments)},this.getClearAlpha=function(){return P.getClearAlpha()},this.setClearAlpha=function(){P.setClearAlpha(...arguments)},this.clear=function(b=!0,D=!0,$=!0){let z=0;if(b){let G=!1;if(ie!==null){let fe=ie.texture.format;G=p.has(fe)}if(G){let fe=ie.texture.type,be=m.has(fe),ue=P.getClearColor(),xe=P.getClearAlpha(),Te=ue.r,Be=ue.g,Ze=ue.b;be?(S[0]=Te,S[1]=Be,S[2]=Ze,S[3]=xe,k.clearBufferuiv(k.COLOR,0,S)):(R[0]=Te,R[1]=Be,R[2]=Ze,R[3]=xe,k.clearBufferiv(k.COLOR,0,R))}else z|=k.COLOR_BUFFER_BIT}D&&(z|=k.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),$&&(z|=k.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),z!==0&&k.clear(z)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(b){b.setRenderer(this),V=b},this.dispose=function(){t.removeEventListener("webglcontextlost",Ce,!1),t.removeEventListener("webglcontextrestored",We,!1),t.removeEventListener("webglcontextcreationerror",me,!1),P.dispose(),de.dispose(),j.dispose(),Fe.dispose(),Pe.dispose(),C.dispose(),se.dispose(),B.dispose(),le.dispose(),Ee.dispose(),ee.dispose(),re.dispose(),re.removeEventListener("sessionstart",Dh),re.removeEventListener("sessionend",Nh),zi.stop()};function Ce(b){b.preventDefault(),zc("WebGLRenderer: Context Lost."),U=!0}function We(){zc("WebGLRenderer: Context Restored."),U=!1;let b=Tt.autoReset,D=ce.enabled,$=ce.autoUpdate,z=ce.needsUpdate,G=ce.type;$e(),Tt.autoReset=b,ce.enabled=D,ce.autoUpdate=$,ce.needsUpdate=z,ce.type=G}function me(b){Oe("WebGLRenderer: A WebGL context could not be created. Reason: ",b.statusMessage)}function ot(b){let D=b.target;D.removeEventListener("dispose",ot),Lt(D)}function Lt(b){di(b),Pe.remove(b)}function di(b){let D=Pe.get(b).programs;D!==void 0&&(D.forEach(function($){ee.releaseProgram($)}),b.isShaderMaterial&&ee.releaseShaderCache(b))}this.renderBufferDirect=function(b,D,$,z,G,fe){D===null&&(D=fn);let be=G.isMesh&&G.matrixWorld.determinantAffine()<0,ue=om(b,D,$,z,G);pe.setMaterial(z,be);let xe=$.index,Te=1;if(z.wireframe===!0){if(xe=B.getWireframeAttribute($),xe===void 0)return;Te=2}let Be=$.drawRange,Ze=$.attributes.position,we=Be.start*Te,je=(Be.start+Be.count)*Te;fe!==null&&(we=Math.max(we,fe.start*Te),je=Math.min(je,(fe.start+fe.count)*Te)),xe!==null?(we=Math.max(we,0),je=Math.min(je,xe.count)):Ze!=null&&(we=Math.max(we,0),je=Math.min(je,Ze.count));let St=je-we;if(St<0||St===1/0)return;le.setup(G,z,ue,$,xe);let dt,ht=X;if(xe!==null&&(dt=y.get(xe),ht=he,ht.setIndex(dt)),G.isMesh)z.wireframe===!0?(pe.setLineWidth(z.wireframeLinewidth*mn()),ht.setMode(k.LINES)):ht.setMode(k.TRIANGLES);else if(G.isLine){let Ft=z.linewidth;Ft===void 0&&(Ft=1),pe.setLineWidth(Ft*mn()),G.isLineSegments?ht.setMode(k.LINES):G.isLineLoop?ht.setMode(k.LINE_LOOP):ht.setMode(k.LINE_STRIP)}else G.isPoints?ht.setMode(k.POINTS):G.isSprite&&ht.setMode(k.TRIANGLES);if(G.isBatchedMesh)if(pt.get("WEBGL_multi_draw"))ht.renderMultiDraw(G._multiDrawStarts,G._multiDrawCounts,G._multiDrawCount);else{let Ft=G._multiDrawStarts,Me=G._multiDrawCounts,$t=G._multiDrawCount,et=xe?y.get(xe).bytesPerElement:1,Bi=Pe.get(z).currentProgram.getUniforms();for(let zt=0;zt<$t;zt++)Bi.setValue(k,"_gl_DrawID",zt),ht.render(Ft[zt]/et,Me[zt])}else if(G.isInstancedMesh)ht.renderInstances(we,St,G.count);else if($.isInstancedBufferGeometry){let Ft=$._maxInstanceCount!==void 0?$._maxInstanceCount:1/0,Me=Math.min($.instanceCount,Ft);ht.renderInstances(we,St,Me)}else ht.render(we,St)};function Lh(b,D,$,z){V!==null&&b.isNodeMaterial&&V.setObject(z,b),At===!0&&K.setState(b,$,!1),b.transparent===!0&&b.side===dn&&b.forceSinglePass===!1?(b.side=jt,b.needsUpdate=!0,Qs(b,D,z),b.side=Li,b.needsUpdate=!0,Qs(b,D,z),b.side=dn):Qs(b,D,z)}this.compile=function(b,D,$=null){$===null&&($=b),V!==null&&V.renderStart(b,D,$),E=j.get($),E.init(D),A.push(E),$.traverseVisible(function(G){G.isLight&&G.layers.test(D.layers)&&(E.pushLight(G),G.castShadow&&E.pushShadow(G))}),b!==$&&b.traverseVisible(function(G){G.isLight&&G.layers.test(D.layers)&&(E.pushLight(G),G.castShadow&&E.pushShadow(G))}),E.setupLights(),V!==null&&V.updateLights(E.state.lightsArray),Jt=this.localClippingEnabled,At=K.init(this.clippingPlanes,Jt),At===!0&&K.setGlobalState(this.clippingPlanes,D),V!==null&&ce.render(E.state.shadowsArray,$,D);let z=new Set;return b.traverse(function(G){if(!(G.isMesh||G.isPoints||G.isLine||G.isSprite))return;let fe=G.material;if(fe)if(Array.isArray(fe))for(let be=0;be<fe.length;be++){let ue=fe[be];Lh(ue,$,D,G),z.add(ue)}else Lh(fe,$,D,G),z.add(fe)}),E=A.pop(),V!==null&&V.renderEnd(),z},this.compileAsync=function(b,D,$=null){let z=this.compile(b,D,$);return new Promise(G=>{function fe(){if(z.forEach(function(be){let xe=Pe.get(be).currentProgram;(xe===void 0||xe.isReady())&&z.delete(be)}),z.size===0){G(b);return}setTimeout(fe,10)}pt.get("KHR_parallel_shader_compile")!==null?fe():setTimeout(fe,10)})};let El=null;function sm(b){El&&El(b)}function Dh(){zi.stop()}function Nh(){zi.start()}let zi=new Mf;zi.setAnimationLoop(sm),typeof self<"u"&&zi.setContext(self),this.setAnimationLoop=function(b){El=b,re.setAnimationLoop(b),b===null?zi.stop():zi.start()},re.addEventListener("sessionstart",Dh),re.addEventListener("sessionend",Nh),this.render=function(b,D){if(D!==void 0&&D.isCamera!==!0){Oe("WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(U===!0)return;V!==null&&V.renderStart(b,D);let $=re.enabled===!0&&re.isPresenting===!0,z=F!==null&&(ie===null||$)&&F.begin(N,ie);if(b.matrixWorldAutoUpdate===!0&&b.updateMatrixWorld(),D.parent===null&&D.matrixWorldAutoUpdate===!0&&D.updateMatrixWorld(),re.enabled===!0&&re.isPresenting===!0&&(F===null||F.isCompositing()===!1)&&(re.cameraAutoUpdate===!0&&re.updateCamera(D),D=re.getCamera()),b.isScene===!0&&b.onBeforeRender(N,b,D,ie),E=j.get(b,A.length),E.init(D),E.state.textureUnits=Fe.getTextureUnits(),A.push(E),gt.multiplyMatrices(D.projectionMatrix,D.matrixWorldInverse),D.isArrayCamera?Ot.setFromArrayCamera(D):Ye.setFromProjectionMatrix(gt,bn,D.reversedDepth),Jt=this.localClippingEnabled,At=K.init(this.clippingPlanes,Jt),M=de.get(b,_.length),M.init(),_.push(M),this.info.render.frame++,re.enabled===!0&&re.isPresenting===!0){let be=N.xr.getDepthSensingMesh();be!==null&&Cl(be,D,-1/0,N.sortObjects)}Cl(b,D,0,N.sortObjects),M.finish(),V!==null&&V.updateLights(E.state.lightsArray),N.sortObjects===!0&&M.sort(Ge,bt),pn=re.enabled===!1||re.isPresenting===!1||re.hasDepthSensing()===!1,pn&&P.addToRenderList(M,b),this.info.autoReset===!0&&this.info.reset(),At===!0&&K.beginShadows();let G=E.state.shadowsArray;if(ce.render(G,b,D),At===!0&&K.endShadows(),(z&&F.hasRenderPass())===!1){let be=M.opaque,ue=M.transmissive;if(E.setupLights(),D.isArrayCamera){let xe=D.cameras;if(ue.length>0)for(let Te=0,Be=xe.length;Te<Be;Te++){let Ze=xe[Te];Oh(be,ue,b,Ze)}pn&&P.render(b);for(let Te=0,Be=xe.length;Te<Be;Te++){let Ze=xe[Te];kh(M,b,Ze,Ze.viewport)}}else ue.length>0&&Oh(be,ue,b,D),pn&&P.render(b),kh(M,b,D)}ie!==null&&W===0&&(Fe.updateMultisampleRenderTarget(ie),Fe.updateRenderTargetMipmap(ie)),z&&F.end(N),b.isScene===!0&&b.onAfterRender(N,b,D),le.resetDefaultState(),Y=-1,te=null,A.pop(),A.length>0?(E=A[A.length-1],Fe.setTextureUnits(E.state.textureUnits),At===!0&&K.setGlobalState(N.clippingPlanes,E.state.camera)):E=null,_.pop(),_.length>0?M=_[_.length-1]:M=null,V!==null&&V.renderEnd()};function Cl(b,D,$,z){if(b.visible===!1)return;if(b.layers.test(D.layers)){if(b.isGroup)$=b.renderOrder;else if(b.isLOD)b.autoUpdate===!0&&b.update(D);else if(b.isLight)E.pushLight(b),b.castShadow&&E.pushShadow(b);else if(b.isSprite){let be=D.isArrayCamera?Ot:Ye;if(!b.frustumCulled||b.intersectsFrustum(be)){z&&It.setFromMatrixPosition(b.matrixWorld).applyMatrix4(gt);let ue=se.update(b),xe=b.material;xe.visible&&M.push(b,ue,xe,$,It.z,null,D)}}else if(b.isMesh||b.isLine||b.isPoints){let be=D.isArrayCamera?Ot:Ye;if(!b.frustumCulled||b.intersectsFrustum(be)){let ue=se.update(b),xe=b.material;if(z&&(b.boundingSphere!==void 0?(b.boundingSphere===null&&b.computeBoundingSphere(),It.copy(b.boundingSphere.center)):(ue.boundingSphere===null&&ue.computeBoundingSphere(),It.copy(ue.boundingSphere.center)),It.applyMatrix4(b.matrixWorld).applyMatrix4(gt)),Array.isArray(xe)){let Te=ue.groups;for(let Be=0,Ze=Te.length;Be<Ze;Be++){let we=Te[Be],je=xe[we.materialIndex];je&&je.visible&&M.push(b,ue,je,$,It.z,we,D)}}else xe.visible&&M.push(b,ue,xe,$,It.z,null,D)}}}let fe=b.children;for(let be=0,ue=fe.length;be<ue;be++)Cl(fe[be],D,$,z)}function kh(b,D,$,z){let{opaque:G,transmissive:fe,transparent:be}=b;E.setupLightsView($),At===!0&&K.setGlobalState(N.clippingPlanes,$),z&&pe.viewport(ne.copy(z)),G.length>0&&eo(G,D,$),fe.length>0&&eo(fe,D,$),be.length>0&&eo(be,D,$),pe.buffers.depth.setTest(!0),pe.buffers.depth.setMask(!0),pe.buffers.color.setMask(!0),pe.setPolygonOffset(!1)}function Oh(b,D,$,z){if(($.isScene===!0?$.overrideMaterial:null)!==null)return;if(E.state.transmissionRenderTarget[z.id]===void 0){let we=pt.has("EXT_color_buffer_half_float")||pt.has("EXT_color_buffer_float");E.state.transmissionRenderTarget[z.id]=new Yt(1,1,{generateMipmaps:!0,type:we?Dn:Ht,minFilter:oi,samples:Math.max(4,mt.samples),stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:Ke.workingColorSpace})}let fe=E.state.transmissionRenderTarget[z.id],be=z.viewport||ne;fe.setSize(be.z*N.transmissionResolutionScale,be.w*N.transmissionResolutionScale);let ue=N.getRenderTarget(),xe=N.getActiveCubeFace(),Te=N.getActiveMipmapLevel();N.setRenderTarget(fe),N.getClearColor(J),_e=N.getClearAlpha(),_e<1&&N.setClearColor(16777215,.5),N.clear(),pn&&P.render($);let Be=N.toneMapping;N.toneMapping=Gn;let Ze=z.viewport;if(z.viewport!==void 0&&(z.viewport=void 0),E.setupLightsView(z),At===!0&&K.setGlobalState(N.clippingPlanes,z),eo(b,$,z),Fe.updateMultisampleRenderTarget(fe),Fe.updateRenderTargetMipmap(fe),pt.has("WEBGL_multisampled_render_to_texture")===!1){let we=!1;for(let je=0,St=D.length;je<St;je++){let dt=D[je],{object:ht,geometry:Ft,material:Me,group:$t}=dt;if(Me.side===dn&&ht.layers.test(z.layers)){let et=Me.side;Me.side=jt,Me.needsUpdate=!0,Uh(ht,$,z,Ft,Me,$t),Me.side=et,Me.needsUpdate=!0,we=!0}}we===!0&&(Fe.updateMultisampleRenderTarget(fe),Fe.updateRenderTargetMipmap(fe))}N.setRenderTarget(ue,xe,Te),N.setClearColor(J,_e),Ze!==void 0&&(z.viewport=Ze),N.toneMapping=Be}function eo(b,D,$){let z=D.isScene===!0?D.overrideMaterial:null;for(let G=0,fe=b.length;G<fe;G++){let be=b[G],{object:ue,geometry:xe,group:Te}=be,Be=be.material;Be.allowOverride===!0&&z!==null&&(Be=z),ue.layers.test($.layers)&&Uh(ue,D,$,xe,Be,Te)}}function Uh(b,D,$,z,G,fe){V!==null&&G.isNodeMaterial&&V.setObject(b,G),b.onBeforeRender(N,D,$,z,G,fe),b.modelViewMatrix.multiplyMatrices($.matrixWorldInverse,b.matrixWorld),b.normalMatrix.getNormalMatrix(b.modelViewMatrix),G.onBeforeRender(N,D,$,z,b,fe),G.transparent===!0&&G.side===dn&&G.forceSinglePass===!1?(G.side=jt,G.needsUpdate=!0,N.renderBufferDirect($,D,z,G,b,fe),G.side=Li,G.needsUpdate=!0,N.renderBufferDirect($,D,z,G,b,fe),G.side=dn):N.renderBufferDirect($,D,z,G,b,fe),b.onAfterRender(N,D,$,z,G,fe)}function Fh(b){let D=0;for(let $ of b)$.texture!==null&&D++;return D}function Qs(b,D,$){D.isScene!==!0&&(D=fn);let z=Pe.get(b),G=E.state.lights,fe=E.state.shadowsArray,be=G.state.version,ue=ee.getParameters(b,G.state,fe,D,$,E.state.lightProbeGridArray),xe=ee.getProgramCacheKey(ue),Te=z.programs;z.environment=b.isMeshStandardMaterial||b.isMeshLambertMaterial||b.isMeshPhongMaterial?D.environment:null,z.fog=D.fog;let Be=b.isMeshStandardMaterial||b.isMeshLambertMaterial&&!b.envMap||b.isMeshPhongMaterial&&!b.envMap;z.envMap=C.get(b.envMap||z.environment,Be),z.envMapRotation=z.environment!==null&&b.envMap===null?D.environmentRotation:b.envMapRotation,Te===void 0&&(b.addEventListener("dispose",ot),Te=new Map,z.programs=Te,z.programVariants=new Map);let Ze=Te.get(xe);if(Ze!==void 0){if(z.currentProgram===Ze&&z.lightsStateVersion===be)return Bh(b,ue),Ze}else ue.uniforms=ee.getUniforms(b),V!==null&&b.isNodeMaterial&&V.build(b,$,ue),b.onBeforeCompile(ue,N),Ze=ee.acquireProgram(ue,xe),Te.set(xe,Ze),z.uniforms=ue.uniforms;let we=z.uniforms;return(!b.isShaderMaterial&&!b.isRawShaderMaterial||b.clipping===!0)&&(we.clippingPlanes=K.uniform),Bh(b,ue),z.needsLights=lm(b),z.lightsStateVersion=be,z.needsLights&&(we.ambientLightColor.value=G.state.ambient,we.lightProbe.value=G.state.probe,we.sunLights.value=G.state.sun,we.sunLightShadows.value=G.state.sunShadow,we.directionalLights.value=G.state.directional,we.directionalLightShadows.value=G.state.directionalShadow,we.spotLights.value=G.state.spot,we.spotLightShadows.value=G.state.spotShadow,we.rectAreaLights.value=G.state.rectArea,we.ltc_1.value=G.state.rectAreaLTC1,we.ltc_2.value=G.state.rectAreaLTC2,we.pointLights.value=G.state.point,we.pointLightShadows.value=G.state.pointShadow,we.hemisphereLights.value=G.state.hemi,we.sunShadowMatrix.value=G.state.sunShadowMatrix,we.sunShadowCascade.value=G.state.sunShadowCascade,we.directionalShadowMatrix.value=G.state.directionalShadowMatrix,we.spotLightMatrix.value=G.state.spotLightMatrix,we.spotLightMap.value=G.state.spotLightMap,we.pointShadowMatrix.value=G.state.pointShadowMatrix),z.numLightProbeGrids=Fh(E.state.lightProbeGridArray),z.currentProgram=Ze,z.uniformsList=null,Ze}function rm(b,D,$,z,G){let fe=Pe.get(b),be=fe.currentProgram.id+","+z+","+G,ue=fe.programVariants.get(be);return ue===void 0?(ue=Qs(b,D,$),fe.programVariants.set(be,ue)):(fe.currentProgram=ue,fe.uniformsList=null,fe.outputColorSpace=z,fe.toneMapping=G),ue}function zh(b){if(b.uniformsList===null){let D=b.currentProgram.getUniforms();b.uniformsList=qs.seqWithValue(D.seq,b.uniforms)}return b.uniformsList}function Bh(b,D){let $=Pe.get(b);$.outputColorSpace=D.outputColorSpace,$.batching=D.batching,$.batchingColor=D.batchingColor,$.instancing=D.instancing,$.instancingColor=D.instancingColor,$.instancingMorph=D.instancingMorph,$.skinning=D.skinning,$.morphTargets=D.morphTargets,$.morphNormals=D.morphNormals,$.morphColors=D.morphColors,$.morphTargetsCount=D.morphTargetsCount,$.numClippingPlanes=D.numClippingPlanes,$.numIntersection=D.numClipIntersection,$.vertexAlphas=D.vertexAlphas,$.vertexTangents=D.vertexTangents,$.toneMapping=D.toneMapping}function om(b,D,$,z,G){D.isScene!==!0&&(D=fn),Fe.resetTextureUnits();let fe=D.fog,be=z.isMeshStandardMaterial||z.isMeshLambertMaterial||z.isMeshPhongMaterial?D.environment:null,ue=ie===null?N.outputColorSpace:ie.isXRRenderTarget===!0?ie.texture.colorSpace:Ke.workingColorSpace,xe=z.isMeshStandardMaterial||z.isMeshLambertMaterial&&!z.envMap||z.isMeshPhongMaterial&&!z.envMap,Te=C.get(z.envMap||be,xe),Be=z.vertexColors===!0&&!!$.attributes.color&&$.attributes.color.itemSize===4,Ze=!!$.attributes.tangent&&(!!z.normalMap||z.anisotropy>0),we=!!$.morphAttributes.position,je=!!$.morphAttributes.normal,St=!!$.morphAttributes.color,dt=Gn;z.toneMapped&&(ie===null||ie.isXRRenderTarget===!0)&&(dt=N.toneMapping);let ht=$.morphAttributes.position||$.morphAttributes.normal||$.morphAttributes.color,Ft=ht!==void 0?ht.length:0,Me=Pe.get(z),$t=E.state.lights;if(At===!0&&(Jt===!0||b!==te)){let _t=b===te&&z.id===Y;K.setState(z,b,_t)}let et=!1,Bi=!1;z.version===Me.__version?Me.needsLights&&Me.lightsStateVersion!==$t.state.version||G.isBatchedMesh&&Me.batching===!1||!G.isBatchedMesh&&Me.batching===!0||G.isBatchedMesh&&Me.batchingColor===!0&&G._colorsTexture===null||G.isBatchedMesh&&Me.batchingColor===!1&&G._colorsTexture!==null||G.isInstancedMesh&&Me.instancing===!1||!G.isInstancedMesh&&Me.instancing===!0||G.isSkinnedMesh&&Me.skinning===!1||!G.isSkinnedMesh&&Me.skinning===!0||G.isInstancedMesh&&Me.instancingColor===!0&&G.instanceColor===null||G.isInstancedMesh&&Me.instancingColor===!1&&G.instanceColor!==null||G.isInstancedMesh&&Me.instancingMorph===!0&&G.morphTexture===null||G.isInstancedMesh&&Me.instancingMorph===!1&&G.morphTexture!==null||Me.envMap!==Te||z.fog===!0&&Me.fog!==fe||Me.numClippingPlanes!==void 0&&(Me.numClippingPlanes!==K.numPlanes||Me.numIntersection!==K.numIntersection)||Me.vertexAlphas!==Be||Me.vertexTangents!==Ze||Me.morphTargets!==we||Me.morphNormals!==je||Me.morphColors!==St||Me.morphTargetsCount!==Ft||Me.numLightProbeGrids!==Fh(E.state.lightProbeGridArray)?et=!0:(Me.outputColorSpace!==ue||Me.toneMapping!==dt)&&(Bi=!0):(et=!0,Me.__version=z.version);let zt=Me.currentProgram;(et===!0||Bi===!0)&&(zt=Bi===!0?rm(z,D,G,ue,dt):Qs(z,D,G),V&&z.isNodeMaterial&&V.onUpdateProgram(z,zt,Me));let to=!1,fi=!1,Vi=!1,Qe=zt.getUniforms(),Ut=Me.uniforms;if(pe.useProgram(zt.program)&&(to=!0,fi=!0,Vi=!0),z.id!==Y&&(Y=z.id,fi=!0),to||te!==b){pe.buffers.depth.getReversed()&&b.reversedDepth!==!0&&(b._reversedDepth=!0,b.updateProjectionMatrix()),Qe.setValue(k,"projectionMatrix",b.projectionMatrix),Qe.setValue(k,"viewMatrix",b.matrixWorldInverse);let Dt=Qe.map.cameraPosition;Dt!==void 0&&Dt.setValue(k,kn.setFromMatrixPosition(b.matrixWorld)),mt.logarithmicDepthBuffer&&Qe.setValue(k,"logDepthBufFC",2/(Math.log(b.far+1)/Math.LN2)),(z.isMeshPhongMaterial||z.isMeshToonMaterial||z.isMeshLambertMaterial||z.isMeshBasicMaterial||z.isMeshStandardMaterial||z.isShaderMaterial)&&Qe.setValue(k,"isOrthographic",b.isOrthographicCamera===!0),te!==b&&(te=b,fi=!0,Vi=!0)}if(Me.needsLights&&($t.state.sunShadowMap.length>0&&Qe.setValue(k,"sunShadowMap",$t.state.sunShadowMap,Fe),$t.state.directionalShadowMap.length>0&&Qe.setValue(k,"directionalShadowMap",$t.state.directionalShadowMap,Fe),$t.state.spotShadowMap.length>0&&Qe.setValue(k,"spotShadowMap",$t.state.spotShadowMap,Fe),$t.state.pointShadowMap.length>0&&Qe.setValue(k,"pointShadowMap",$t.state.pointShadowMap,Fe)),G.isSkinnedMesh){Qe.setOptional(k,G,"bindMatrix"),Qe.setOptional(k,G,"bindMatrixInverse");let _t=G.skeleton;_t&&(_t.boneTexture===null&&_t.computeBoneTexture(),Qe.setValue(k,"boneTexture",_t.boneTexture,Fe))}G.isBatchedMesh&&(Qe.setOptional(k,G,"batchingTexture"),Qe.setValue(k,"batchingTexture",G._matricesTexture,Fe),Qe.setOptional(k,G,"batchingIdTexture"),Qe.setValue(k,"batchingIdTexture",G._indirectTexture,Fe),Qe.setOptional(k,G,"batchingColorTexture"),G._colorsTexture!==null&&Qe.setValue(k,"batchingColorTexture",G._colorsTexture,Fe));let wn=$.morphAttributes;if((wn.position!==void 0||wn.normal!==void 0||wn.color!==void 0)&&Q.update(G,$,zt),(fi||Me.receiveShadow!==G.receiveShadow)&&(Me.receiveShadow=G.receiveShadow,Qe.setValue(k,"receiveShadow",G.receiveShadow)),(z.isMeshStandardMaterial||z.isMeshLambertMaterial||z.isMeshPhongMaterial)&&z.envMap===null&&D.environment!==null&&(Ut.envMapIntensity.value=D.environmentIntensity),Ut.dfgLUT!==void 0&&(Ut.dfgLUT.value=ry()),fi){if(Qe.setValue(k,"toneMappingExposure",N.toneMappingExposure),Me.needsLights&&am(Ut,Vi),fe&&z.fog===!0&&ae.refreshFogUniforms(Ut,fe),ae.refreshMaterialUniforms(Ut,z,ve,Re,E.state.transmissionRenderTarget[b.id]),Me.needsLights&&Me.numLightProbeGrids>0){let _t=T,Dt=0;for(let Xn of E.state.lightProbeGridArray)Xn.texture!==null&&(_t.textures[Dt]=Xn.texture,_t.min[Dt]=Xn.boundingBox.min,_t.max[Dt]=Xn.boundingBox.max,_t.resolution[Dt]=Xn.resolution,Dt++);for(let Xn in _t)_t[Xn].length=Dt;Ut.probesSH.value=_t.textures,Ut.probesMin.value=_t.min,Ut.probesMax.value=_t.max,Ut.probesResolution.value=_t.resolution}qs.upload(k,zh(Me),Ut,Fe)}if(z.isShaderMaterial&&z.uniformsNeedUpdate===!0&&(qs.upload(k,zh(Me),Ut,Fe),z.uniformsNeedUpdate=!1),z.isSpriteMaterial&&Qe.setValue(k,"center",G.center),Qe.setValue(k,"modelViewMatrix",G.modelViewMatrix),Qe.setValue(k,"normalMatrix",G.normalMatrix),Qe.setValue(k,"modelMatrix",G.matrixWorld),z.uniformsGroups!==void 0){let _t=z.uniformsGroups;for(let Dt=0,Xn=_t.length;Dt<Xn;Dt++){let Gh=_t[Dt];Ee.update(Gh,zt),Ee.bind(Gh,zt)}}return zt}function am(b,D){b.ambientLightColor.needsUpdate=D,b.lightProbe.needsUpdate=D,b.sunLights.needsUpdate=D,b.sunLightShadows.needsUpdate=D,b.directionalLights.needsUpdate=D,b.directionalLightShadows.needsUpdate=D,b.pointLights.needsUpdate=D,b.pointLightShadows.needsUpdate=D,b.spotLights.needsUpdate=D,b.spotLightShadows.needsUpdate=D,b.rectAreaLights.needsUpdate=D,b.hemisphereLights.needsUpdate=D}function lm(b){return b.isMeshLambertMaterial||b.isMeshToonMaterial||b.isMeshPhongMaterial||b.isMeshStandardMaterial||b.isShadowMaterial||b.isShaderMaterial&&b.lights===!0}this.getActiveCubeFace=function(){return Z},this.getActiveMipmapLevel=function(){return W},this.getRenderTarget=function(){return ie},this.setRenderTargetTextures=function(b,D,$){let z=Pe.get(b);z.__autoAllocateDepthBuffer=b.resolveDepthBuffer===!1,z.__autoAllocateDepthBuffer===!1&&(z.__useRenderToTexture=!1),Pe.get(b.texture).__webglTexture=D,Pe.get(b.depthTexture).__webglTexture=z.__autoAllocateDepthBuffer?void 0:$,z.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(b,D){let $=Pe.get(b);$.__webglFramebuffer=D,$.__useDefaultFramebuffer=D===void 0},this.setRenderTarget=function(b,D=0,$=0){ie=b,Z=D,W=$;let z=null,G=!1,fe=!1;if(b){let ue=Pe.get(b);if(ue.__useDefaultFramebuffer!==void 0){pe.bindFramebuffer(k.FRAMEBUFFER,ue.__webglFramebuffer),ne.copy(b.viewport),Ae.copy(b.scissor),ze=b.scissorTest,pe.viewport(ne),pe.scissor(Ae),pe.setScissorTest(ze),Y=-1;return}else if(ue.__webglFramebuffer===void 0)Fe.setupRenderTarget(b);else if(ue.__hasExternalTextures)Fe.rebindTextures(b,Pe.get(b.texture).__webglTexture,Pe.get(b.depthTexture).__webglTexture);else if(b.depthBuffer){let Be=b.depthTexture;if(ue.__boundDepthTexture!==Be){if(Be!==null&&Pe.has(Be)&&(b.width!==Be.image.width||b.height!==Be.image.height))throw new Error("THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.");Fe.setupDepthRenderbuffer(b)}}let xe=b.texture;(xe.isData3DTexture||xe.isDataArrayTexture||xe.isCompressedArrayTexture)&&(fe=!0);let Te=Pe.get(b).__webglFramebuffer;b.isWebGLCubeRenderTarget?(Array.isArray(Te[D])?z=Te[D][$]:z=Te[D],G=!0):b.samples>0&&Fe.useMultisampledRTT(b)===!1?z=Pe.get(b).__webglMultisampledFramebuffer:Array.isArray(Te)?z=Te[$]:z=Te,ne.copy(b.viewport),Ae.copy(b.scissor),ze=b.scissorTest}else ne.copy(Ne).multiplyScalar(ve).floor(),Ae.copy(rt).multiplyScalar(ve).floor(),ze=ct;if($!==0&&(z=q),pe.bindFramebuffer(k.FRAMEBUFFER,z)&&pe.drawBuffers(b,z),pe.viewport(ne),pe.scissor(Ae),pe.setScissorTest(ze),G){let ue=Pe.get(b.texture);k.framebufferTexture2D(k.FRAMEBUFFER,k.COLOR_ATTACHMENT0,k.TEXTURE_CUBE_MAP_POSITIVE_X+D,ue.__webglTexture,$)}else if(fe){let ue=D;for(let xe=0;xe<b.textures.length;xe++){let Te=Pe.get(b.textures[xe]);k.framebufferTextureLayer(k.FRAMEBUFFER,k.COLOR_ATTACHMENT0+xe,Te.__webglTexture,$,ue)}}else if(b!==null&&$!==0){let ue=Pe.get(b.texture);k.framebufferTexture2D(k.FRAMEBUFFER,k.COLOR_ATTACHMENT0,k.TEXTURE_2D,ue.__webglTexture,$)}Y=-1};function Vh(b){let D=Pe.get(b);return(D.__readFormat!==b.format||D.__readType!==b.type)&&(D.__readFormat=b.format,D.__readType=b.type,D.__formatReadable=mt.textureFormatReadable(b.format),D.__typeReadable=mt.textureTypeReadable(b.type)),D}this.readRenderTargetPixels=function(b,D,$,z,G,fe,be,ue=0){if(!(b&&b.isWebGLRenderTarget)){Oe("WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let xe=Pe.get(b).__webglFramebuffer;if(b.isWebGLCubeRenderTarget&&be!==void 0&&(xe=xe[be],Array.isArray(xe)&&(xe=xe[0])),xe){pe.bindFramebuffer(k.FRAMEBUFFER,xe);try{let Te=b.textures[ue],Be=Te.format,Ze=Te.type;b.textures.length>1&&k.readBuffer(k.COLOR_ATTACHMENT0+ue);let we=Vh(Te);if(we.__formatReadable===!1){Oe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(we.__typeReadable===!1){Oe("WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}D>=0&&D<=b.width-z&&$>=0&&$<=b.height-G&&k.readPixels(D,$,z,G,oe.convert(Be),oe.convert(Ze),fe)}finally{let Te=ie!==null?Pe.get(ie).__webglFramebuffer:null;pe.bindFramebuffer(k.FRAMEBUFFER,Te)}}},this.readRenderTargetPixelsAsync=async function(b,D,$,z,G,fe,be,ue=0){if(!(b&&b.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let xe=Pe.get(b).__webglFramebuffer;if(b.isWebGLCubeRenderTarget&&be!==void 0&&(xe=xe[be],Array.isArray(xe)&&(xe=xe[0])),xe)if(D>=0&&D<=b.width-z&&$>=0&&$<=b.height-G){pe.bindFramebuffer(k.FRAMEBUFFER,xe);let Te=b.textures[ue],Be=Te.format,Ze=Te.type;b.textures.length>1&&k.readBuffer(k.COLOR_ATTACHMENT0+ue);let we=Vh(Te);if(we.__formatReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(we.__typeReadable===!1)throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");let je=k.createBuffer();k.bindBuffer(k.PIXEL_PACK_BUFFER,je),k.bufferData(k.PIXEL_PACK_BUFFER,fe.byteLength,k.STREAM_READ),k.readPixels(D,$,z,G,oe.convert(Be),oe.convert(Ze),0),k.bindBuffer(k.PIXEL_PACK_BUFFER,null);let St=ie!==null?Pe.get(ie).__webglFramebuffer:null;pe.bindFramebuffer(k.FRAMEBUFFER,St);let dt=k.fenceSync(k.SYNC_GPU_COMMANDS_COMPLETE,0);return k.flush(),await Yd(k,dt,4),k.bindBuffer(k.PIXEL_PACK_BUFFER,je),k.getBufferSubData(k.PIXEL_PACK_BUFFER,0,fe),k.bindBuffer(k.PIXEL_PACK_BUFFER,null),k.deleteBuffer(je),k.deleteSync(dt),fe}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")},this.copyFramebufferToTexture=function(b,D=null,$=0){let z=Math.pow(2,-$),G=Math.floor(b.image.width*z),fe=Math.floor(b.image.height*z),be=D!==null?D.x:0,ue=D!==null?D.y:0;Fe.setTexture2D(b,0),k.copyTexSubImage2D(k.TEXTURE_2D,$,0,0,be,ue,G,fe),pe.unbindTexture()},this.copyTextureToTexture=function(b,D,$=null,z=null,G=0,fe=0){let be,ue,xe,Te,Be,Ze,we,je,St,dt=b.isCompressedTexture?b.mipmaps[fe]:b.image;if($!==null)be=$.max.x-$.min.x,ue=$.max.y-$.min.y,xe=$.isBox3?$.max.z-$.min.z:1,Te=$.min.x,Be=$.min.y,Ze=$.isBox3?$.min.z:0;else{let Qe=Math.pow(2,-G);be=Math.floor(dt.width*Qe),ue=Math.floor(dt.height*Qe),b.isDataArrayTexture?xe=dt.depth:b.isData3DTexture?xe=Math.floor(dt.depth*Qe):xe=1,Te=0,Be=0,Ze=0}z!==null?(we=z.x,je=z.y,St=z.z):(we=0,je=0,St=0);let ht=oe.convert(D.format),Ft=oe.convert(D.type),Me;D.isData3DTexture?(Fe.setTexture3D(D,0),Me=k.TEXTURE_3D):D.isDataArrayTexture||D.isCompressedArrayTexture?(Fe.setTexture2DArray(D,0),Me=k.TEXTURE_2D_ARRAY):(Fe.setTexture2D(D,0),Me=k.TEXTURE_2D),pe.activeTexture(k.TEXTURE0),pe.pixelStorei(k.UNPACK_FLIP_Y_WEBGL,D.flipY),pe.pixelStorei(k.UNPACK_PREMULTIPLY_ALPHA_WEBGL,D.premultiplyAlpha),pe.pixelStorei(k.UNPACK_ALIGNMENT,D.unpackAlignment);let $t=pe.getParameter(k.UNPACK_ROW_LENGTH),et=pe.getParameter(k.UNPACK_IMAGE_HEIGHT),Bi=pe.getParameter(k.UNPACK_SKIP_PIXELS),zt=pe.getParameter(k.UNPACK_SKIP_ROWS),to=pe.getParameter(k.UNPACK_SKIP_IMAGES);pe.pixelStorei(k.UNPACK_ROW_LENGTH,dt.width),pe.pixelStorei(k.UNPACK_IMAGE_HEIGHT,dt.height),pe.pixelStorei(k.UNPACK_SKIP_PIXELS,Te),pe.pixelStorei(k.UNPACK_SKIP_ROWS,Be),pe.pixelStorei(k.UNPACK_SKIP_IMAGES,Ze);let fi=b.isDataArrayTexture||b.isData3DTexture,Vi=D.isDataArrayTexture||D.isData3DTexture;if(b.isDepthTexture){let Qe=Pe.get(b),Ut=Pe.get(D),wn=Pe.get(Qe.__renderTarget),_t=Pe.get(Ut.__renderTarget);pe.bindFramebuffer(k.READ_FRAMEBUFFER,wn.__webglFramebuffer),pe.bindFramebuffer(k.DRAW_FRAMEBUFFER,_t.__webglFramebuffer);for(let Dt=0;Dt<xe;Dt++)fi&&(k.framebufferTextureLayer(k.READ_FRAMEBUFFER,k.COLOR_ATTACHMENT0,Pe.get(b).__webglTexture,G,Ze+Dt),k.framebufferTextureLayer(k.DRAW_FRAMEBUFFER,k.COLOR_ATTACHMENT0,Pe.get(D).__webglTexture,fe,St+Dt)),k.blitFramebuffer(Te,Be,Te+be,Be+ue,we,je,we+be,je+ue,k.DEPTH_BUFFER_BIT,k.NEAREST);pe.bindFramebuffer(k.READ_FRAMEBUFFER,null),pe.bindFramebuffer(k.DRAW_FRAMEBUFFER,null)}else if(G!==0||b.isRenderTargetTexture||Pe.has(b)){let Qe=Pe.get(b),Ut=Pe.get(D);pe.bindFramebuffer(k.READ_FRAMEBUFFER,I),pe.bindFramebuffer(k.DRAW_FRAMEBUFFER,H);for(let wn=0;wn<xe;wn++)fi?k.framebufferTextureLayer(k.READ_FRAMEBUFFER,k.COLOR_ATTACHMENT0,Qe.__webglTexture,G,Ze+wn):k.framebufferTexture2D(k.READ_FRAMEBUFFER,k.COLOR_ATTACHMENT0,k.TEXTURE_2D,Qe.__webglTexture,G),Vi?k.framebufferTextureLayer(k.DRAW_FRAMEBUFFER,k.COLOR_ATTACHMENT0,Ut.__webglTexture,fe,St+wn):k.framebufferTexture2D(k.DRAW_FRAMEBUFFER,k.COLOR_ATTACHMENT0,k.TEXTURE_2D,Ut.__webglTexture,fe),G!==0?k.blitFramebuffer(Te,Be,Te+be,Be+ue,we,je,we+be,je+ue,k.COLOR_BUFFER_BIT,k.NEAREST):Vi?k.copyTexSubImage3D(Me,fe,we,je,St+wn,Te,Be,be,ue):k.copyTexSubImage2D(Me,fe,we,je,Te,Be,be,ue);pe.bindFramebuffer(k.READ_FRAMEBUFFER,null),pe.bindFramebuffer(k.DRAW_FRAMEBUFFER,null)}else Vi?b.isDataTexture||b.isData3DTexture?k.texSubImage3D(Me,fe,we,je,St,be,ue,xe,ht,Ft,dt.data):D.isCompressedArrayTexture?k.compressedTexSubImage3D(Me,fe,we,je,St,be,ue,xe,ht,dt.data):k.texSubImage3D(Me,fe,we,je,St,be,ue,xe,ht,Ft,dt):b.isDataTexture?k.texSubImage2D(k.TEXTURE_2D,fe,we,je,be,ue,ht,Ft,dt.data):b.isCompressedTexture?k.compressedTexSubImage2D(k.TEXTURE_2D,fe,we,je,dt.width,dt.height,ht,dt.data):k.texSubImage2D(k.TEXTURE_2D,fe,we,je,be,ue,ht,Ft,dt);pe.pixelStorei(k.UNPACK_ROW_LENGTH,$t),pe.pixelStorei(k.UNPACK_IMAGE_HEIGHT,et),pe.pixelStorei(k.UNPACK_SKIP_PIXELS,Bi),pe.pixelStorei(k.UNPACK_SKIP_ROWS,zt),pe.pixelStorei(k.UNPACK_SKIP_IMAGES,to),fe===0&&D.generateMipmaps===!0&&D.mipmapsAutoUpdate===!0&&k.generateMipmap(Me),pe.unbindTexture()},this.initRenderTarget=function(b){Pe.get(b).__webglFramebuffer===void 0&&Fe.setupRenderTarget(b)},this.initTexture=function(b){b.isCubeTexture?Fe.setTextureCube(b,0):b.isData3DTexture?Fe.setTexture3D(b,0):b.isDataArrayTexture||b.isCompressedArrayTexture?Fe.setTexture2DArray(b,0):Fe.setTexture2D(b,0),pe.unbindTexture()},this.resetState=function(){Z=0,W=0,ie=null,pe.reset(),le.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return bn}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=Ke._getDrawingBufferColorSpace(e),t.unpackColorSpace=Ke._getUnpackColorSpace()}};var kf={type:"change"},rh={type:"start"},Uf={type:"end"},ol=new Qi,Of=new ln,oy=Math.cos(70*Hc.DEG2RAD),Pt=new O,nn=2*Math.PI,nt={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},sh=1e-6,al=class extends Er{constructor(e,t=null){super(e,t),this.state=nt.NONE,this.target=new O,this.cursor=new O,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:Pi.ROTATE,MIDDLE:Pi.DOLLY,RIGHT:Pi.PAN},this.touches={ONE:Ii.ROTATE,TWO:Ii.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle="auto",this._domElementKeyEvents=null,this._lastPosition=new O,this._lastQuaternion=new cn,this._lastTargetPosition=new O,this._quat=new cn().setFromUnitVectors(e.up,new O(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new Bs,this._sphericalDelta=new Bs,this._scale=1,this._panOffset=new O,this._rotateStart=new De,this._rotateEnd=new De,this._rotateDelta=new De,this._panStart=new De,this._panEnd=new De,this._panDelta=new De,this._dollyStart=new De,this._dollyEnd=new De,this._dollyDelta=new De,this._dollyDirection=new O,this._mouse=new De,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=ly.bind(this),this._onPointerDown=ay.bind(this),this._onPointerUp=cy.bind(this),this._onContextMenu=gy.bind(this),this._onMouseWheel=dy.bind(this),this._onKeyDown=fy.bind(this),this._onTouchStart=py.bind(this),this._onTouchMove=my.bind(this),this._onMouseDown=hy.bind(this),this._onMouseMove=uy.bind(this),this._interceptControlDown=_y.bind(this),this._interceptControlUp=vy.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e==="grab"?this.domElement.style.cursor="grab":this.domElement.style.cursor="auto"}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.state=nt.NONE,this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction="",this.domElement.style.cursor="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(kf),this.update(),this.state=nt.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;Pt.copy(t).sub(this.target),Pt.applyQuaternion(this._quat),this._spherical.setFromVector3(Pt),this.autoRotate&&this.state===nt.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let i=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(i)&&isFinite(s)&&(i<-Math.PI?i+=nn:i>Math.PI&&(i-=nn),s<-Math.PI?s+=nn:s>Math.PI&&(s-=nn),i<=s?this._spherical.theta=Math.max(i,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(i+s)/2?Math.max(i,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let o=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=o!=this._spherical.radius}if(Pt.setFromSpherical(this._spherical),Pt.applyQuaternion(this._quatInverse),t.copy(this.target).add(Pt),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let o=null;if(this.object.isPerspectiveCamera){let a=Pt.length();o=this._clampDistance(a*this._scale);let l=a-o;this.object.position.addScaledVector(this._dollyDirection,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){let a=new O(this._mouse.x,this._mouse.y,0);a.unproject(this.object);let l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;let c=new O(this._mouse.x,this._mouse.y,0);c.unproject(this.object),this.object.position.sub(c).add(a),this.object.updateMatrixWorld(),o=Pt.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;o!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(o).add(this.object.position):(ol.origin.copy(this.object.position),ol.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(ol.direction))<oy?this.object.lookAt(this.target):(Of.setFromNormalAndCoplanarPoint(this.object.up,this.target),ol.intersectPlane(Of,this.target))))}else if(this.object.isOrthographicCamera){let o=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),o!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>sh||8*(1-this._lastQuaternion.dot(this.object.quaternion))>sh||this._lastTargetPosition.distanceToSquared(this.target)>sh?(this.dispatchEvent(kf),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e!==null?nn/60*this.autoRotateSpeed*e:nn/60/60*this.autoRotateSpeed}_getZoomScale(e){let t=Math.abs(e*.01);return Math.pow(.95,this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){Pt.setFromMatrixColumn(t,0),Pt.multiplyScalar(-e),this._panOffset.add(Pt)}_panUp(e,t){this.screenSpacePanning===!0?Pt.setFromMatrixColumn(t,1):(Pt.setFromMatrixColumn(t,0),Pt.crossVectors(this.object.up,Pt)),Pt.multiplyScalar(e),this._panOffset.add(Pt)}_pan(e,t){let i=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;Pt.copy(s).sub(this.target);let r=Pt.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*r/i.clientHeight,this.object.matrix),this._panUp(2*t*r/i.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/i.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/i.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let i=this.domElement.getBoundingClientRect(),s=e-i.left,r=t-i.top,o=i.width,a=i.height;this._mouse.x=s/o*2-1,this._mouse.y=-(r/a)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(nn*this._rotateDelta.x/t.clientHeight),this._rotateUp(nn*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(nn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-nn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(nn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-nn*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0;break}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),i=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._rotateStart.set(i,s)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),i=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panStart.set(i,s)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),i=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(i*i+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let i=this._getSecondPointerPosition(e),s=.5*(e.pageX+i.x),r=.5*(e.pageY+i.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(nn*this._rotateDelta.x/t.clientHeight),this._rotateUp(nn*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),i=.5*(e.pageX+t.x),s=.5*(e.pageY+t.y);this._panEnd.set(i,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),i=e.pageX-t.x,s=e.pageY-t.y,r=Math.sqrt(i*i+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let o=(e.pageX+t.x)*.5,a=(e.pageY+t.y)*.5;this._updateZoomParameters(o,a)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new De,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,i={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:i.deltaY*=16;break;case 2:i.deltaY*=100;break}return e.ctrlKey&&!this._controlActive&&(i.deltaY*=10),i}};function ay(n){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(n.pointerId),this.domElement.ownerDocument.addEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(n)&&(this._addPointer(n),n.pointerType==="touch"?this._onTouchStart(n):this._onMouseDown(n),this._cursorStyle==="grab"&&(this.domElement.style.cursor="grabbing")))}function ly(n){this.enabled!==!1&&(n.pointerType==="touch"?this._onTouchMove(n):this._onMouseMove(n))}function cy(n){switch(this._removePointer(n),this._pointers.length){case 0:this.domElement.releasePointerCapture(n.pointerId),this.domElement.ownerDocument.removeEventListener("pointermove",this._onPointerMove),this.domElement.ownerDocument.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(Uf),this.state=nt.NONE,this._cursorStyle==="grab"&&(this.domElement.style.cursor="grab");break;case 1:let e=this._pointers[0],t=this._pointerPositions[e];this._onTouchStart({pointerId:e,pageX:t.x,pageY:t.y});break}}function hy(n){let e;switch(n.button){case 0:e=this.mouseButtons.LEFT;break;case 1:e=this.mouseButtons.MIDDLE;break;case 2:e=this.mouseButtons.RIGHT;break;default:e=-1}switch(e){case Pi.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(n),this.state=nt.DOLLY;break;case Pi.ROTATE:if(n.ctrlKey||n.metaKey||n.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(n),this.state=nt.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(n),this.state=nt.ROTATE}break;case Pi.PAN:if(n.ctrlKey||n.metaKey||n.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(n),this.state=nt.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(n),this.state=nt.PAN}break;default:this.state=nt.NONE}this.state!==nt.NONE&&this.dispatchEvent(rh)}function uy(n){switch(this.state){case nt.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(n);break;case nt.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(n);break;case nt.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(n);break}}function dy(n){this.enabled===!1||this.enableZoom===!1||this.state!==nt.NONE||(n.preventDefault(),this.dispatchEvent(rh),this._handleMouseWheel(this._customWheelEvent(n)),this.dispatchEvent(Uf))}function fy(n){this.enabled!==!1&&this._handleKeyDown(n)}function py(n){switch(this._trackPointer(n),this._pointers.length){case 1:switch(this.touches.ONE){case Ii.ROTATE:if(this.enableRotate===!1){this.state=nt.NONE;break}this._handleTouchStartRotate(n),this.state=nt.TOUCH_ROTATE;break;case Ii.PAN:if(this.enablePan===!1){this.state=nt.NONE;break}this._handleTouchStartPan(n),this.state=nt.TOUCH_PAN;break;default:this.state=nt.NONE}break;case 2:switch(this.touches.TWO){case Ii.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(n),this.state=nt.TOUCH_DOLLY_PAN;break;case Ii.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(n),this.state=nt.TOUCH_DOLLY_ROTATE;break;default:this.state=nt.NONE}break;default:this.state=nt.NONE}this.state!==nt.NONE&&this.dispatchEvent(rh)}function my(n){switch(this._trackPointer(n),this.state){case nt.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(n),this.update();break;case nt.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(n),this.update();break;case nt.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(n),this.update();break;case nt.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(n),this.update();break;default:this.state=nt.NONE}}function gy(n){this.enabled!==!1&&n.preventDefault()}function _y(n){n.key==="Control"&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function vy(n){n.key==="Control"&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}var Ff=1.7,xy=4,Br=Math.PI/180,yy=[35,50].flatMap(n=>[25,-25,50,-50,75,-75].map(e=>[-Math.sin(e*Br)*Math.cos(n*Br),-Math.cos(e*Br)*Math.cos(n*Br),Math.sin(n*Br)])),by=1.05,ll=class{constructor(e,t){this.camera=new qt(50,1,.1,5e3),this.camera.up.set(0,0,1),this.orbit=new al(this.camera,e),Object.assign(this.orbit,{zoomToCursor:!0,screenSpacePanning:!1,maxPolarAngle:1.75,enableDamping:!1}),this.orbit.addEventListener("change",t),this.changed=t,this.kind="orbit",this.keys=new Set,this.groundAt=()=>null;let i=null;e.addEventListener("pointermove",s=>{if(this.kind==="orbit"||!s.isPrimary||!(s.buttons&1)){i=null;return}i&&this.turn((i[0]-s.clientX)*.004,(i[1]-s.clientY)*.004),i=[s.clientX,s.clientY]}),e.addEventListener("pointerup",()=>{i=null})}show(e,t=!1,[i,s,r,o]=[-1,1,-1,1]){let a=[0,1,2].map(T=>e.reduce((M,E)=>Math.min(M,E[0][T]),1/0)),l=[0,1,2].map(T=>e.reduce((M,E)=>Math.max(M,E[1][T]),-1/0)),c=Math.hypot(...a.map((T,M)=>l[M]-T))||10;this.size=c;let h=e.flatMap(T=>[0,1,2,3,4,5,6,7].map(M=>[0,1,2].map(E=>T[M>>E&1][E]))),d=Math.tan(this.camera.fov*Math.PI/360),u=[[i*d*this.camera.aspect,s*d*this.camera.aspect],[r*d,o*d]],f=T=>{this.camera.position.set(...T),this.camera.lookAt(0,0,0);let M=[0,1,2].map(V=>new O().setComponent(V,1).applyQuaternion(this.camera.quaternion)),E=[-1/0,1/0,-1/0,1/0],_=-1/0,A=h.map(([V,q,I])=>M.map(H=>V*H.x+q*H.y+I*H.z));for(let V of A)u.forEach(([q,I],H)=>{E[2*H]=Math.max(E[2*H],V[H]+I*V[2]),E[2*H+1]=Math.min(E[2*H+1],V[H]+q*V[2])}),_=Math.max(_,V[2]);let F=Math.max(...u.map(([V,q],I)=>(E[2*I]-E[2*I+1])/(q-V)),_+.05*c),N=u.map(([V,q],I)=>(E[2*I]-q*F+E[2*I+1]-V*F)/2),U=u.map(([V,q],I)=>{let H=A.map(Z=>(Z[I]-N[I])/(F-Z[2]));return(H.reduce((Z,W)=>Math.max(Z,W))-H.reduce((Z,W)=>Math.min(Z,W)))/(q-V)});return{way:T,axes:M,back:F,place:N,filled:U[0]*U[1]}},g=t?[[0,-.001,1]]:yy,{way:w,axes:p,back:m,place:S}=g.map(f).reduce((T,M)=>M.filled>by*T.filled?M:T);this.camera.position.set(...w),this.camera.lookAt(0,0,0),this.camera.position.set(0,0,0).addScaledVector(p[0],S[0]).addScaledVector(p[1],S[1]).addScaledVector(p[2],m);let R=new O(...a.map((T,M)=>(T+l[M])/2));this.orbit.target.copy(this.camera.position).addScaledVector(p[2],R.dot(p[2])-m),this.shown={middle:R,from:this.camera.position.clone()},this.camera.near=Math.max(c/5e3,.05),this.camera.far=c*8,this.camera.updateProjectionMatrix(),this.kind="orbit",this.orbit.enabled=!0,this.camera.lookAt(this.orbit.target),this.orbit.update(),this.changed()}setKind(e){this.kind=e,this.orbit.enabled=e==="orbit";let t=this.camera.getWorldDirection(new O);if(e==="orbit")this.orbit.target.copy(this.camera.position).addScaledVector(t,Math.max(20,this.camera.position.z)),this.orbit.update();else if(e==="walk"){let{x:i,y:s}=this.shown?.from.equals(this.camera.position)?this.shown.middle:this.orbit.target,[r,o,a]=this.groundAt(i,s)??[i,s,this.orbit.target.z];this.camera.position.set(r,o,a+Ff),t.z=0,this.camera.lookAt(this.camera.position.clone().add(t.lengthSq()>1e-6?t:new O(0,1,0)))}this.changed()}turn(e,t){if(this.kind==="orbit"){this.orbit._rotateLeft(-e),this.orbit._rotateUp(-t),this.orbit.update();return}let i=this.camera.getWorldDirection(new O),s=Math.atan2(i.y,i.x)+e,r=Math.max(-1.5,Math.min(1.5,Math.asin(i.z)+t)),o=new O(Math.cos(s)*Math.cos(r),Math.sin(s)*Math.cos(r),Math.sin(r));this.camera.lookAt(this.camera.position.clone().add(o)),this.changed()}zoom(e){let{position:t}=this.camera;t.sub(this.orbit.target).multiplyScalar(e).add(this.orbit.target),this.orbit.update(),this.changed()}go(e,t,i){let s=this.camera.getWorldDirection(new O);this.kind!=="fly"&&s.setZ(0).normalize();let r=new O().crossVectors(s,this.camera.up).normalize(),o=this.kind==="orbit"?this.size/60:xy/4,a=s.multiplyScalar(e*o).addScaledVector(r,t*o).add(new O(0,0,i*o));if(this.camera.position.add(a),this.kind==="orbit"&&this.orbit.target.add(a),this.kind==="walk"){let{x:l,y:c,z:h}=this.camera.position,d=this.groundAt(l,c);d&&(this.camera.position.z=h+(d[2]+Ff-h)*.5)}this.kind==="orbit"&&this.orbit.update(),this.changed()}stand([e,t,i]){let s=this.camera.getWorldDirection(new O).setZ(0);this.camera.position.set(e,t,i),this.camera.lookAt(this.camera.position.clone().add(s)),this.changed()}};var Vr=`
vec4 packed(float d) { float v = clamp(d, 0.0, 0.9999999) * 16777215.0; float h = floor(v / 65536.0); float m = floor((v - h * 65536.0) / 256.0);
  return vec4(h, m, v - h * 65536.0 - m * 256.0, 255.0) / 255.0; }`;var zf=`precision highp float; precision highp int;
#define LOOSE ${.6}
in uvec4 place; in uint value; in uvec4 shape;
#ifdef COLORED
in uint rgb565;
#else
const uint rgb565 = 0u;
#endif
uniform mat4 modelViewMatrix, projectionMatrix; uniform vec3 low, step3, sun, cutLow, cutHigh; uniform vec2 heights; uniform int mode, cleared, layered; uniform float size, pixels, most, light;
uniform sampler2D table; flat out vec4 color; flat out vec2 slope; flat out vec3 range;
void main() {
  vec3 local = low + vec3(place.xyz) * step3;
  vec4 view = modelViewMatrix * vec4(local, 1.0);
  bool isCut = any(lessThan(local, cutLow)) || any(greaterThan(local, cutHigh));
  gl_Position = int(value) == cleared || isCut ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * view;
  bool isSurface = shape.y + shape.z + shape.w > 0u;
  float wide = size * float(shape.x) / 64.0 * pixels / max(-view.z, 0.01);
  // single points near the eye would stand before all else
  gl_PointSize = isSurface ? clamp(wide, 1.6, most) : clamp(LOOSE * wide, min(max(wide, 1.6), 6.0), 0.1 * most);
  range = vec3(-view.z, 0.5 * gl_PointSize * max(-view.z, 0.01) / pixels, isSurface ? 0.0 : smoothstep(2.5, 6.0, gl_PointSize));
  slope = vec2(0.0);
  float shine = 0.9;
  if (isSurface) {
    vec3 n = normalize(vec3(shape.yzw) - 128.0);
    vec3 seen = mat3(modelViewMatrix) * n;
    if (dot(seen, view.xyz) > 0.0) { seen = -seen; n = -n; }
    float facing = max(-dot(seen, normalize(view.xyz)), 0.3);
    // small discs stay round: what is thinner than a pixel has gaps
    slope = seen.xy / facing * smoothstep(2.5, 6.0, gl_PointSize);
    shine = 0.55 + 0.1 * (1.0 + n.z) + 0.38 * max(dot(n, sun), 0.0);
  }
  float index = 0.0;
  if (mode == 0) index = float(place.w & 255u); else if (mode == 1) index = float(place.w >> 8u);
  else if (mode == 2) index = clamp((local.z - heights.x) / max(heights.y - heights.x, 0.001), 0.0, 1.0) * 255.0; else index = float(value);
  float own = mix(1.0, shine, light);
  vec3 said = mode == 3 ? vec3(float(rgb565 >> 11u) / 31.0, float((rgb565 >> 5u) & 63u) / 63.0, float(rgb565 & 31u) / 31.0)
    : texture(table, vec2((index + 0.5) / 256.0, 0.5)).rgb;
  // answers become layers, for which light and answer stay apart: half of one, the place of the other in the table
  color = layered == 1 && value < 255u ? vec4(vec3(0.5 * own), index / 255.0) : vec4(said * own, 1.0);
}`,Bf=`precision highp float; flat in vec4 color; flat in vec2 slope; flat in vec3 range; uniform mat4 projectionMatrix; uniform float far;
layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${Vr}
void main() { vec2 o = gl_PointCoord * 2.0 - 1.0; o.y = -o.y; float rise = dot(slope, o); float q = dot(o, o) + rise * rise; if (q > 1.05) discard;
  float ball = range.z * sqrt(max(1.0 - q, 0.0)), d = range.x + range.y * (rise - 0.7 * ball);
  shown = vec4(color.rgb * mix(1.0, 0.72 + 0.26 * ball + 0.12 * o.y, range.z), color.a); far24 = packed(d / far);
  // discs that touch part their surface between them
  gl_FragDepth = clamp(0.5 - 0.5 * projectionMatrix[2][2] + 0.5 * projectionMatrix[3][2] / max(d + 0.3 * range.y * q, 1e-4), 0.0, 1.0); }`,Vf=`precision highp float; in vec4 ball; uniform mat4 modelViewMatrix, projectionMatrix; uniform float pixels;
out vec3 middle; out float radius;
void main() { vec4 view = modelViewMatrix * vec4(ball.xyz, 1.0); middle = view.xyz; radius = ball.w;
  gl_Position = projectionMatrix * view; gl_PointSize = clamp(2.15 * ball.w * pixels / max(-view.z, 0.01), 1.5, 1000.0); }`,Gf=`precision highp float; in vec3 middle; in float radius; uniform mat4 projectionMatrix; uniform float far; uniform vec3 tint;
layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${Vr}
void main() { vec2 o = (gl_PointCoord - 0.5) * 2.15; o.y = -o.y; float h = 1.0 - dot(o, o); if (h < 0.0) discard; vec3 n = vec3(o, sqrt(h));
  vec3 at = middle + radius * n; vec4 clip = projectionMatrix * vec4(at, 1.0); gl_FragDepth = clip.z / clip.w * 0.5 + 0.5;
  shown = vec4(tint * (0.45 + 0.55 * max(dot(n, normalize(vec3(0.3, 0.6, 0.75))), 0.0)), 1.0); far24 = packed(-at.z / far); }`,Hf=`precision highp float; in vec3 corner; uniform mat4 modelViewMatrix, projectionMatrix; out vec3 at;
void main() { vec4 view = modelViewMatrix * vec4(corner, 1.0); at = view.xyz; gl_Position = projectionMatrix * view; }`,Wf=`precision highp float; in vec3 at; uniform float far; uniform vec3 tint; layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${Vr}
void main() { vec3 n = normalize(cross(dFdx(at), dFdy(at))); shown = vec4(tint * (0.5 + 0.5 * abs(dot(n, normalize(vec3(0.3, 0.6, 0.75))))), 1.0); far24 = packed(-at.z / far); }`,$f=`precision highp float; in vec3 corner, other; in float side; uniform mat4 modelViewMatrix, projectionMatrix; uniform vec2 screen; uniform float wide, lift, pixels; out vec3 at;
vec4 lifted(vec3 place) { vec4 view = modelViewMatrix * vec4(place, 1.0); float range = length(view.xyz); view.xyz *= max(1.0 - lift / range, 0.5); return view; }
void main() { vec4 view = lifted(corner), p = projectionMatrix * view, q = projectionMatrix * lifted(other); at = view.xyz;
  // an end behind the eye has no place on the screen
  if (q.w < 0.1 && p.w > 0.1) q = mix(p, q, (p.w - 0.1) / (p.w - q.w));
  vec2 way = (q.xy / q.w - p.xy / p.w) * screen; way /= max(length(way), 1e-6);
  float own = clamp(0.5 * pixels / max(p.w, 0.1), 0.4 * wide, wide); gl_Position = p + vec4(side * own * vec2(-way.y, way.x) / screen * p.w, 0.0, 0.0); }`,qf=`precision highp float; in vec3 at; uniform float far; uniform vec3 tint; layout(location = 0) out vec4 shown; layout(location = 1) out vec4 far24;${Vr}
void main() { shown = vec4(tint, 1.0); far24 = packed(-at.z / far); }`,Xf="precision highp float; in vec3 position; out vec2 uv; void main() { uv = position.xy * 0.5 + 0.5; gl_Position = vec4(position.xy, 0.0, 1.0); }",Yf=`precision highp float; precision highp int; uniform sampler2D shown, far24, table; uniform float far, reach, pixels, least; uniform bool kinds; uniform int taps;
layout(location = 0) out vec4 color; layout(location = 1) out vec4 depth;${Vr}
float at(vec4 t) { return dot(t.rgb, vec3(65536.0, 256.0, 1.0)) * 255.0 / 16777215.0 * far; }
vec3 said(float index) { return texture(table, vec2((index * 255.0 + 0.5) / 256.0, 0.5)).rgb; }
void main() { ivec2 p = ivec2(gl_FragCoord.xy), most = textureSize(far24, 0) - 1; vec4 own = texelFetch(shown, p, 0); depth = texelFetch(far24, p, 0);
  color = own; if (depth.a < 0.5) return;
  bool isAnswer = own.a < 0.998;
  float d = at(depth), span = isAnswer ? max(reach, least * d / pixels) : 0.5 * reach, wide = min(span * pixels / max(d, 0.01), 60.0);
  if (!isAnswer && wide < 1.5) return;
  vec2 from = vec2(p) - 0.5 * vec2(most); float kind[8] = float[8](0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0); kind[min(int(own.a * 255.0 + 0.5), 7)] = 1.0;
  vec3 sum = said(own.a), light = own.rgb; float whole = 1.0, near = 1.0, depths = d;
  int count = isAnswer ? taps : taps / 2;
  for (int i = 0; i < count; i++) {
    float a = float(i) * 2.3999632, r = sqrt((float(i) + 0.5) / float(count)) * wide; ivec2 q = clamp(p + ivec2(round(r * vec2(cos(a), sin(a)))), ivec2(0), most);
    vec4 other = texelFetch(shown, q, 0), z = texelFetch(far24, q, 0); if ((other.a < 0.998) != isAnswer || z.a < 0.5) continue;
    float e = at(z); vec3 to = vec3(((vec2(q) - 0.5 * vec2(most)) * e - from * d) / pixels, e - d); float apart = dot(to, to), w = exp(-2.0 * apart / (span * span)), v = exp(-9.0 * apart / (reach * reach));
    kind[min(int(other.a * 255.0 + 0.5), 7)] += w; sum += w * said(other.a); whole += w; light += v * other.rgb; depths += v * e; near += v; }
  light /= near; depth = packed(depths / near / far); color = vec4(light, 1.0); if (!isAnswer) return;
  vec3 answer = sum / whole;
  if (kinds) { int first = 0, second = -1; for (int k = 1; k < 8; k++) if (kind[k] > kind[first]) first = k;
    for (int k = 0; k < 8; k++) if (k != first && (second < 0 || kind[k] > kind[second])) second = k;
    // a line of a pixel or two between both
    answer = mix(said(float(second) / 255.0), said(float(first) / 255.0), 0.5 + 0.5 * smoothstep(0.0, 0.2, (kind[first] - kind[second]) / whole)); }
  color = vec4(2.0 * light * answer, 1.0); }`,Zf=`precision highp float; precision highp int; uniform sampler2D shown, far24; uniform float far, gap, widest, pixels; uniform int reach, free;
layout(location = 0) out vec4 color; layout(location = 1) out vec4 depth;
float at(ivec2 p) { vec4 t = texelFetch(far24, p, 0); return t.a < 0.5 ? 1e9 : dot(t.rgb, vec3(65536.0, 256.0, 1.0)) * 255.0 / 16777215.0 * far; }
void main() { ivec2 p = ivec2(gl_FragCoord.xy), most = textureSize(far24, 0) - 1; float own = at(p);
  float limit = own - gap - 0.004 * min(own, 1e6); float furthest = 0.0; int count = 0; ivec2 taken = p;
  // without any at the corners there are no five
  for (int i = 0; i < 8; i++) { if (i == 4 && count == 0) break;
    ivec2 q = clamp(p + reach * (i < 4 ? ivec2(2 * (i & 1) - 1, (i & 2) - 1) : i < 6 ? ivec2(2 * (i & 1) - 1, 0) : ivec2(0, 2 * (i & 1) - 1)), ivec2(0), most); float d = at(q);
    if (d < limit && (reach <= free || float(reach) * d < widest * pixels)) { count++; if (d > furthest) { furthest = d; taken = q; } } }
  if (count < 5) taken = p; color = texelFetch(shown, taken, 0); depth = texelFetch(far24, taken, 0); }`,jf=`precision highp float; uniform sampler2D shown, far24; uniform vec2 texel, slopes; uniform vec3 zenith, horizon, below, sun; uniform mat4 turned; uniform float far, strength, ratio, glow; uniform int rings;
in vec2 uv; out vec4 color;
float at(vec4 t) { return log2(max(dot(t.rgb, vec3(65536.0, 256.0, 1.0)) * 255.0 / 16777215.0 * far, 0.01)); }
vec3 sky() { vec3 ray = normalize(mat3(turned) * vec3((uv * 2.0 - 1.0) * slopes, -1.0));
  vec3 c = ray.z > 0.0 ? mix(horizon, zenith, 1.0 - pow(1.0 - ray.z, 2.5)) : mix(horizon, below, smoothstep(0.0, 0.2, -ray.z));
  float to = dot(ray, sun); return mix(c, vec3(1.0, 0.96, 0.84), glow * min(0.35 * pow(max(to, 0.0), 60.0) + smoothstep(0.9992, 0.9996, to), 1.0)); }
void main() { vec4 own = texture(far24, uv); if (own.a < 0.5) { color = vec4(sky(), 1.0); return; }
  float d = at(own), sum = 0.0;
  for (int i = 0; i < 8; i++) { float a = float(i) * 0.7853982 + 0.2; vec2 to = vec2(cos(a), sin(a)) * texel * ratio;
    for (int k = 0; k < rings; k++) { vec4 t = texture(far24, uv + (k == 0 ? 1.3 : 4.0) * to); if (t.a >= 0.5) sum += clamp(d - at(t), 0.0, 0.05); } }
  color = vec4(texture(shown, uv).rgb * max(exp(-strength * sum / float(8 * rings)), 0.6), 1.0); }`;var[Sy,wy]=[[24,12,6,3,2,1],3],[My,Ay]=[28,3],Ty={light:{zenith:"#9fc3e6",horizon:"#eaf1f7",below:"#dfe4e8"},dark:{zenith:"#0a1018",horizon:"#2b3644",below:"#151a20"}},Ni=n=>Object.fromEntries(Object.entries(n).map(([e,t])=>[e,{value:t}])),oh=()=>new Yt(1,1,{count:2,magFilter:yt,minFilter:yt}),cl=class{constructor(e){this.renderer=e,this.filled=[0,1].map(()=>Object.assign(oh(),{depthBuffer:!1}));let t=(s,r)=>{let o={glslVersion:Hn,depthTest:!1,depthWrite:!1,vertexShader:Xf,fragmentShader:s,uniforms:Ni({shown:null,far24:null,far:1e3,...r})};return new Pn(o)};this.smooth=t(Yf,{table:null,reach:1,pixels:1,least:1,kinds:!1,taps:0}),this.fill=t(Zf,{gap:1,widest:1,pixels:1,reach:1,free:1}),this.shade=t(jf,{texel:new De,slopes:new De,zenith:new Ve,horizon:new Ve,below:new Ve,sun:new O,turned:new ut,strength:8,ratio:1,glow:0,rings:2});let i=new Gt().setAttribute("position",new kt(new Float32Array([-1,-1,0,3,-1,0,-1,3,0]),3));this.mesh=new Zt(i,this.shade),this.mesh.frustumCulled=!1,this.camera=new Fs}resize(e,t){this.filled.forEach(i=>i.setSize(e,t)),this.shade.uniforms.texel.value.set(1/e,1/t)}pass(e,t,i){return[e.uniforms.shown.value,e.uniforms.far24.value]=t.textures,this.mesh.material=e,this.renderer.setRenderTarget(i),this.renderer.render(this.mesh,this.camera),i}show(e,t,{theme:i,gap:s,widest:r,pixels:o,sun:a,glow:l,isRough:c,smooth:h,isLayer:d}){let{shade:u,fill:f}=this,g=this.renderer.getPixelRatio();for(let[m,S]of Object.entries({gap:s,widest:r,pixels:o,free:wy*g}))f.uniforms[m].value=S;f.uniforms.far.value=u.uniforms.far.value=t.far;let w=e;if((c?[]:Sy).forEach((m,S)=>{f.uniforms.reach.value=Math.max(Math.round(m*g),1),w=this.pass(f,w,this.filled[S%2])}),d||!c){for(let[m,S]of Object.entries({...h,pixels:o,far:t.far,least:Ay*g,taps:c?0:My}))this.smooth.uniforms[m].value=S;w=this.pass(this.smooth,w,this.filled[w===this.filled[0]?1:0])}for(let[m,S]of Object.entries(Ty[i]))u.uniforms[m].value.setStyle(S,"");let p=Math.tan(t.fov*Math.PI/360);u.uniforms.slopes.value.set(p*t.aspect,p),u.uniforms.turned.value.copy(t.matrixWorld),u.uniforms.sun.value.copy(a),u.uniforms.glow.value=l,u.uniforms.ratio.value=g,u.uniforms.rings.value=c?1:2,this.pass(u,w,null)}};var[Ey,Cy,Ry]=[.6,1.8,1.1],Jf=64,Qf=n=>{let e=new Uint8Array(4*n);for(let t=0;t<e.length;t+=4)e[t]=Jf;return e},ki=10;function Kf(n,e){let t=n[e];if(t<4)return null;let[i,s,r]=[n[e+1]/t,n[e+2]/t,n[e+3]/t],[o,a,l,c,h,d]=[n[e+4]/t-i*i,n[e+5]/t-i*s,n[e+6]/t-i*r,n[e+7]/t-s*s,n[e+8]/t-s*r,n[e+9]/t-r*r],u=(o+c+d)/3,f=Math.sqrt(Math.max(((o-u)**2+(c-u)**2+(d-u)**2+2*(a*a+l*l+h*h))/6,1e-18)),[g,w,p,m,S,R]=[(o-u)/f,(c-u)/f,(d-u)/f,a/f,l/f,h/f],T=(g*(w*p-R*R)-m*(m*p-R*S)+S*(m*R-w*S))/2,M=Math.acos(Math.max(-1,Math.min(1,T)))/3,E=u+2*f*Math.cos(M),_=u+2*f*Math.cos(M+2*Math.PI/3),A=3*u-E-_;if(!(_<.06*A)||A<.02*E)return null;let F=[[o-_,a,l],[a,c-_,h],[l,h,d-_]],N=null,U=0;for(let[V,q]of[[0,1],[0,2],[1,2]]){let[I,H]=[F[V],F[q]],Z=[I[1]*H[2]-I[2]*H[1],I[2]*H[0]-I[0]*H[2],I[0]*H[1]-I[1]*H[0]],W=Math.hypot(...Z);W>U&&([U,N]=[W,Z.map(ie=>ie/W)])}return N}function ep(n,e){let t=[0,1,2].map(u=>n.reduce((f,g)=>Math.min(f,g.low[u]),1/0)),i=Math.max(3*e,.001),s=1<<17,r=new Map,o=new Float64Array(ki*4096),a=0,l=n.map(u=>new Int32Array(u.count));n.forEach(({low:u,step:f,places:g,count:w},p)=>{let m=l[p];for(let S=0;S<w;S++){let R=u[0]-t[0]+g[4*S]*f[0],T=u[1]-t[1]+g[4*S+1]*f[1],M=u[2]-t[2]+g[4*S+2]*f[2],E=(Math.floor(R/i)*s+Math.floor(T/i))*s+Math.floor(M/i),_=r.get(E);if(_===void 0&&(_=a++,r.set(E,_),ki*a>o.length)){let F=new Float64Array(2*o.length);F.set(o),o=F}m[S]=_;let A=ki*_;o[A]+=1,o[A+1]+=R,o[A+2]+=T,o[A+3]+=M,o[A+4]+=R*R,o[A+5]+=R*T,o[A+6]+=R*M,o[A+7]+=T*T,o[A+8]+=T*M,o[A+9]+=M*M}});let c=new Uint8Array(4*a),h=new Float64Array(ki),d=u=>{let f=r.get(u);if(f!==void 0)for(let g=0;g<ki;g++)h[g]+=o[ki*f+g]};for(let[u,f]of r){let g=ki*f,w=o[g];h.set(o.subarray(g,g+ki));let p=.25,m=null;for(let[M,E]of[[0,s*s],[1,s],[2,1]]){let _=o[g+1+M]/w/i%1,A=Math.min(_,1-_);A<p&&([p,m]=[A,_<.5?-E:E])}m!==null&&d(u+m);let S=h[0],R=Kf(h,0);if(!R&&S<6){h.fill(0);for(let M of[-1,0,1])for(let E of[-1,0,1])for(let _ of[-1,0,1])d(u+(M*s+E)*s+_);R=Kf(h,0)}let T=Math.min(Math.max(i/Math.sqrt(S)/e,Ey),R?Cy:Ry);c[4*f]=Math.round(Jf*T),R&&R.forEach((M,E)=>{c[4*f+1+E]=Math.round(128+127*M)})}n.forEach(({geometry:u,count:f},g)=>{let w=u.getAttribute("shape");for(let p=0;p<f;p++)for(let m=0;m<4;m++)w.array[4*p+m]=c[4*l[g][p]+m];w.needsUpdate=!0})}var Py=[2,11,17],tp=254,hl=(n,e)=>Object.assign(new kt(n,e),{gpuType:1013}),Iy=2,Ly=1.6,Dy=1.3,np=128,ip=new O(.25,-.75,.75).normalize(),sp=2.5,ah={low:[-1e9,-1e9,-1e9],high:[1e9,1e9,1e9]},Ny=[1,.7,1,.5,.8],lh=3,ul=class{constructor(e){this.renderer=e,this.scene=new ks,this.extra=new ks,this.chunks=[],this.budget=1e6,this.table=new es(new Uint8Array(1024),256,1,tn,Ht),this.own=Ni({table:this.table,mode:2,layered:0,heights:new De,size:.3,pixels:1,far:1e3,most:40,cleared:tp,light:1,sun:ip.clone(),cutLow:new O(...ah.low),cutHigh:new O(...ah.high)}),Object.assign(this,{lineScreen:{value:new De(1,1)},lineWidth:{value:sp}}),this.target=oh(),this.screen=new cl(e),this.isQuick=!1,this.isRough=!1,this.isSunny=!1,this.frustum=new si,this.drawn=this.left=0}add(e,t,i,s,r=0,o=this.own,a=this.scene){let l=new Gt;l.setAttribute("place",hl(i,4)),l.setAttribute("value",hl(s??new Uint8Array(i.length/4),1)),l.setAttribute("shape",hl(Qf(i.length/4),4)),l.setDrawRange(0,i.length/4);let c=e.map((g,w)=>g+t[w]*65535),h=new O(...e.map((g,w)=>(g+c[w])/2));l.boundingSphere=new Bn(h,h.distanceTo(new O(...c)));let d=new Pn({glslVersion:Hn,vertexShader:zf,fragmentShader:Bf,uniforms:{...o,...Ni({low:new O(...e),step3:new O(...t)})}}),u=new Os(l,d);a.add(u);let f={object:u,geometry:l,low:e,step:t,places:i,first:r,count:i.length/4,drawn:0};return a===this.scene&&(this.chunks.push(f),this.left+=f.count,this.setChunkValues(f)),f}async measure(e){let t=new Map;for(let i of this.chunks){let s=`${Math.floor(i.low[0]/np)} ${Math.floor(i.low[1]/np)}`;t.set(s,[...t.get(s)??[],i])}for(let i of t.values())ep(i,e),await new Promise(s=>setTimeout(s,0))}heights(e){let s=Math.min(...this.chunks.map(l=>l.low[2])),r=Math.max(...this.chunks.map(l=>l.low[2]+65535*l.step[2])),o=new Float64Array(2e3),a=0;for(let{low:[,,l],step:[,,c],places:h,count:d}of this.chunks){let u=Math.min(d,2e4);for(let f=0;f<u;f++)o[Math.min(Math.floor((l+h[4*f+2]*c-s)/(r-s||1)*2e3),1999)]+=d/u;a+=d}return e.map(l=>{let c=0;for(let h=o[0];c<1999&&h<l*a;h+=o[c])c+=1;return s+(c+(l>.5?1:0))/2e3*(r-s)})}setSun(e){this.isSunny=e!==null,this.own.sun.value.set(...e??ip)}setCut(e){let{low:t,high:i}=e??ah;this.own.cutLow.value.set(...t),this.own.cutHigh.value.set(...i)}setValues(e){this.values=e??this.cleared?.map(t=>t*tp)??null,this.chunks.forEach(t=>this.setChunkValues(t))}setChunkValues({geometry:e,first:t,count:i}){let s=e.getAttribute("value");this.values?s.copyArray(this.values.subarray(t,t+i)):s.array.fill(0),s.needsUpdate=!0}setColors({geometry:e,object:t},i){e.setAttribute("rgb565",hl(i,1)),t.material.defines={COLORED:1},t.material.needsUpdate=!0}paint({mode:e,table:t,legend:i,light:s=Ny[e]},r=this.own){r.layered.value=e===4&&i&&r===this.own?1:0,r===this.own&&(this.isOfKinds=!!i?.keys),t.forEach((o,a)=>r.table.value.image.data.set([...o.map(Math.round),255],4*a)),r.table.value.needsUpdate=!0,r.mode.value=e,r.light.value=s}layer(e,t,i,s,r,o,a=-1){this.clearLayer();let l=new es(new Uint8Array(1024),256,1,tn,Ht),c={...this.own,...Ni({table:l,mode:4,layered:0,size:r,cleared:a,light:0})};this.add(e,t,i,s,0,c,this.extra),this.paint({...o,light:0},c),this.layerOwn=c}clearLayer(){for(let e of[...this.extra.children].filter(t=>t.isPoints&&!t.isBalls))e.geometry.dispose(),this.extra.remove(e)}addBalls(e){let t=new Gt().setAttribute("ball",new kt(e,4));t.boundingSphere=new Bn(new O,1/0);let i={pixels:this.own.pixels,far:this.own.far,...Ni({tint:new Ve(.42,.62,.86)})};this.balls=new Os(t,new Pn({glslVersion:Hn,vertexShader:Vf,fragmentShader:Gf,uniforms:i})),this.balls.isBalls=!0,this.balls.frustumCulled=!1,t.setDrawRange(0,e.length/4),this.extra.add(this.balls)}addMesh(e){(this.meshes??=[]).push(this.mesh(e,new Ve(.86,.84,.9)))}addLines(e,t){let i=[],s=(r,o,a)=>{let[l,c,h,d]=[r.map((u,f)=>u-a[f]),r.map((u,f)=>u+a[f]),o.map((u,f)=>u-a[f]),o.map((u,f)=>u+a[f])];i.push(...l,...c,...h,...c,...d,...h)};for(let r=0;r<e.length;r+=6){let[o,a]=[[...e.subarray(r,r+3)],[...e.subarray(r+3,r+6)]],[l,c]=[a[0]-o[0],a[1]-o[1]],h=Math.hypot(l,c),d=t/2;h>.001&&s(o,a,[-c/h*d,l/h*d,0]),s(o,a,h>.001?[0,0,d]:[d,0,0]),h<=.001&&s(o,a,[0,d,0])}(this.meshes??=[]).push(this.mesh(new Float32Array(i),new Ve(.85,.05,.4)))}addOutlines(e,[t,i,s]){let r=e.length/6,[o,a]=[new Float32Array(r*12),new Float32Array(r*12)],l=new Float32Array(r*4),c=new Uint32Array(r*6);for(let f=0;f<r;f++){for(let g=0;g<4;g++){let[w,p]=g<2?[0,3]:[3,0];o.set(e.subarray(6*f+w,6*f+w+3),12*f+3*g),a.set(e.subarray(6*f+p,6*f+p+3),12*f+3*g),l[4*f+g]=(g%2?1:-1)*(g<2?1:-1)}c.set([0,1,2,1,3,2].map(g=>4*f+g),6*f)}let h=new Gt().setIndex(new kt(c,1));for(let[f,g,w]of[["corner",o,3],["other",a,3],["side",l,1]])h.setAttribute(f,new kt(g,w));let d={far:this.own.far,pixels:this.own.pixels,lift:this.own.size,screen:this.lineScreen,wide:this.lineWidth,...Ni({tint:new Ve(t/255,i/255,s/255)})},u=new Zt(h,new Pn({glslVersion:Hn,side:dn,vertexShader:$f,fragmentShader:qf,uniforms:d}));u.frustumCulled=!1,this.extra.add(u),(this.outlines??=[]).push(u)}setPlan(e){this.plan?.geometry.dispose(),this.plan&&this.extra.remove(this.plan),this.plan=e?.length?this.mesh(e,new Ve(.87,.55,.75)):null}mesh(e,t){let i=new Gt().setAttribute("corner",new kt(e,3));i.setDrawRange(0,e.length/3);let s={far:this.own.far,...Ni({tint:t})},r=new Zt(i,new Pn({glslVersion:Hn,side:dn,vertexShader:Hf,fragmentShader:Wf,uniforms:s}));return r.frustumCulled=!1,this.extra.add(r),r}resize(e,t){this.target.setSize(e,t),this.screen.resize(e,t),this.lineScreen.value.set(e,t),this.lineWidth.value=sp*this.renderer.getPixelRatio()}render(e,t,i,s){let{own:r,target:o,renderer:a}=this;r.far.value=e.far,r.pixels.value=o.height/(2*Math.tan(e.fov*Math.PI/360)),i&&this.chunks.forEach(c=>{c.drawn=0}),this.share(e,i?this.budget:lh*this.budget),a.setRenderTarget(o),a.autoClear=!1,i&&(a.setClearColor(0,0),a.clear()),a.render(this.scene,e),i&&a.render(this.extra,e),this.isRough=!this.isQuick&&(s||this.left>0);let l={table:this.table,reach:Dy*r.size.value,kinds:this.isOfKinds};this.screen.show(o,e,{smooth:l,isLayer:r.layered.value===1,isRough:this.isRough,theme:t,pixels:r.pixels.value,gap:Iy*r.size.value,widest:Ly*r.size.value,sun:r.sun.value,glow:this.isSunny&&r.sun.value.z>0?1:0}),a.autoClear=!0}share(e,t){e.updateMatrixWorld(),this.frustum.setFromProjectionMatrix(new ut().multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse));let i=this.chunks.filter(({object:a,geometry:l})=>(a.visible=!1,this.frustum.intersectsSphere(l.boundingSphere))),s=i.map(({count:a,drawn:l,geometry:{boundingSphere:{center:c,radius:h}}})=>{let d=Math.max(e.position.distanceTo(c)-h,1);return(a-l)*Math.min(1,(h/d)**2+.02)}),r=s.reduce((a,l)=>a+l,0),o=i.reduce((a,{count:l,drawn:c})=>a+l-c,0);this.drawn=this.left=0,i.forEach((a,l)=>{let c=a.count-a.drawn,h=o<=t?c:Math.min(c,Math.ceil(s[l]*t/r));a.object.visible=h>0,a.geometry.setDrawRange(a.drawn,h),a.drawn+=h,this.drawn+=a.drawn,this.left+=a.count-a.drawn})}depthAt(e,t,i=4){let s=2*i+1,r=new Uint8Array(4*s*s),o=[e-i,this.target.height-1-t-i].map(Math.round);this.renderer.readRenderTargetPixels(this.target,...o,s,s,r,void 0,1);let a=null;for(let l=0;l<s*s;l++){if(r[4*l+3]<128)continue;let c=(l%s-i)**2+(Math.floor(l/s)-i)**2,h=(r[4*l]*65536+r[4*l+1]*256+r[4*l+2])/16777215*this.own.far.value;(!a||c<a.away)&&(a={away:c,depth:h})}return a?.depth??null}nearest([e,t,i]){let s=null,[r,o]=[this.own.cutLow,this.own.cutHigh].map(({value:a})=>a.toArray());for(let{low:a,step:l,places:c,count:h,first:d}of this.chunks){let u=s?Math.sqrt(s.away):3;if(![e,t,i].some((f,g)=>f<a[g]-u||f>a[g]+l[g]*65535+u))for(let f=0;f<h;f++){let g=a[0]+c[4*f]*l[0]-e,w=a[1]+c[4*f+1]*l[1]-t,p=a[2]+c[4*f+2]*l[2]-i,m=g*g+w*w+p*p;(!s||m<s.away)&&[e+g,t+w,i+p].every((S,R)=>S>=r[R]&&S<=o[R])&&(s={away:m,place:[e+g,t+w,i+p],class:c[4*f+3]&255,value:this.values?.[d+f]})}}return s}boxes(){return this.chunks.flatMap(({low:t,step:i,places:s,count:r})=>{let o=this.chunks.length>40?65536:8192,a=new Set;for(let l=0;l<4*r;l+=4)a.add((Math.floor(s[l]/o)*8+Math.floor(s[l+1]/o))*8+Math.floor(s[l+2]/o));return[...a].map(l=>[l>>6,l>>3&7,l&7]).map(l=>[0,1].map(c=>t.map((h,d)=>h+(l[d]+c)*o*i[d])))})}groundAt(e,t){let s=({places:r,count:o},a)=>a<4*Math.min(o,4e4)&&Py.includes(r[a+3]&255);this.hasGround??=this.chunks.some(r=>r.places.some((o,a)=>a%4===0&&s(r,a)));for(let r of[1,3,9,27]){let o=null;for(let a of this.chunks){let{low:l,step:c,places:h,count:d}=a,[u,f]=[e-r-l[0],e+r-l[0]].map(p=>p/c[0]),[g,w]=[t-r-l[1],t+r-l[1]].map(p=>p/c[1]);if(!(f<0||u>65535||w<0||g>65535))for(let p=0;p<4*Math.min(d,4e4);p+=4){if(h[p]<u||h[p]>f||h[p+1]<g||h[p+1]>w||this.hasGround&&!s(a,p))continue;let m=l[2]+h[p+2]*c[2];(!o||m<o[2])&&(o=r>1?[l[0]+h[p]*c[0],l[1]+h[p+1]*c[1],m]:[e,t,m])}}if(o)return o}return null}};var os,ye,Je,ch=33,hh=350,Gr=!1,Hr=!1,uh=null,dh=-1/0,rp;function lt(){Gr=!0,Ys()}function Ys(){Hr||!ye||!(Gr||(ye.left||ye.isRough)&&performance.now()-dh>=hh)||(Hr=!0,requestAnimationFrame(()=>{let n=Gr;Gr=!1;let e=performance.now();ye.render(Je.camera,jn.dataset.theme,n,e-dh<hh),zy(),x.frames=(x.frames??0)+1,ky(()=>{let t=performance.now()-e,i=n?ch:lh*ch;ye.isRough||(ye.isQuick=t<ch);let s=ye.isRough||ye.isQuick;s&&t>1.5*i?ye.budget=Math.max(1e5,ye.budget*Math.max(.5,i/t)):s&&t<.7*i&&ye.left&&(ye.budget=Math.min(2e7,ye.budget*1.3)),Hr=!1,uh?.(),uh=null,Ys()})}))}function ky(n){let e=os.getContext(),t=e.fenceSync(e.SYNC_GPU_COMMANDS_COMPLETE,0);e.flush();let i=()=>{if(t&&!e.isContextLost()&&e.clientWaitSync(t,0,0)===e.TIMEOUT_EXPIRED)return setTimeout(i,2);e.deleteSync(t),n()};setTimeout(i,0)}function op(n){Hr?uh=n:n()}function fh(n=5e3){let e=performance.now();return new Promise(t=>{let i=()=>(Hr||Gr||ye.left||ye.isRough)&&performance.now()-e<n?setTimeout(i,20):t();i()})}x.complete=fh;function Oy(){dh=performance.now(),x.isMoved=!0,lt(),clearTimeout(rp),rp=setTimeout(Ys,hh+10)}function ph(){let[n,e]=[it.clientWidth,it.clientHeight];os.setPixelRatio(Math.min(devicePixelRatio,2)),os.setSize(n,e,!1),ye.resize(it.width,it.height),Je.camera.aspect=n/e,Je.camera.updateProjectionMatrix(),lt()}function Uy(){let n=[0,L("bar").offsetHeight,it.clientWidth,it.clientHeight-L("status").offsetHeight],e=([t,i,s,r])=>Math.max(s-t,0)*Math.max(r-i,0);for(let t of["tools","card","timebar","legend"]){let i=L(t).getBoundingClientRect(),[s,r,o,a]=n;if(!i.width||i.right<=s||i.left>=o||i.bottom<=r||i.top>=a)continue;n=[[i.right,r,o,a],[s,r,i.left,a],[s,i.bottom,o,a],[s,r,o,i.top]].reduce((c,h)=>e(h)>e(c)?h:c)}return n}var Fy=.015;function Oi(n=!1){let[e,t]=[it.clientWidth,it.clientHeight],[i,s,r,o]=Uy(),a=[i,r].map(d=>2*d/e-1),l=[o,s].map(d=>1-2*d/t),c=[a,l].flatMap(([d,u])=>{let f=Math.min(Fy*2,(u-d)/4);return[d+f,u-f]}),h=ye.boxes();Je.show(h.length?h:[[x.scene.low,x.scene.high]],n,c),x.isMoved=!1}var Kt=n=>n.map((e,t)=>Number(((e+x.scene.origin[t])/x.scene.metres_per_unit[t]).toFixed(3))),Ui=n=>n.map((e,t)=>e*x.scene.metres_per_unit[t]-x.scene.origin[t]);x.toFile=Kt;var as=n=>n.map(e=>e.toFixed(2)).join("  ");function dl(n){let e=new O(...n).project(Je.camera);return e.z>1||e.z<-1?null:[(e.x+1)/2*it.clientWidth,(1-e.y)/2*it.clientHeight]}function Wr(n,e){let t=it.width/it.clientWidth,i=ye.depthAt(n*t,e*t,Math.round(5*t));if(i===null)return null;let{camera:s}=Je,r=new O(n/it.clientWidth*2-1,1-e/it.clientHeight*2,.5).unproject(s).sub(s.position).normalize(),o=i/r.dot(s.getWorldDirection(new O));return s.position.clone().addScaledVector(r,o).toArray()}x.placeAt=Wr;x.onScreen=dl;function zy(){let n=[],e=({at:h,label:d,color:u="#1d4e89",down:f=-8,radius:g=6})=>{let w=dl(h);w&&n.push(`${g?`<circle cx="${w[0]}" cy="${w[1]}" r="${g}" fill="${u}" stroke="#fff" stroke-width="2"/>`:""}${d?`<text x="${w[0]+10}" y="${w[1]+f}">${Ie(d)}</text>`:""}`)},t=(h,d,u)=>{let[f,g]=[dl(h),dl(d)];f&&g&&n.push(`<path d="M${f}L${g}" fill="none" ${u}/>`)};for(let h of x.marks)h.line?t(...h.line,h.style):e(h);L("marks").innerHTML=n.join("");let i=Je.camera.getWorldDirection(new O),s=new O(0,1,0).applyQuaternion(Je.camera.quaternion),o=(Math.hypot(i.x,i.y)>.02?Math.atan2(i.x,i.y):Math.atan2(s.x,s.y))+(x.scene?.grid_north_deg??0)*Math.PI/180;L("needle").setAttribute("transform",`rotate(${-o*180/Math.PI})`);let a=Je.kind==="orbit"?Je.camera.position.distanceTo(Je.orbit.target):20,l=it.clientHeight/(2*a*Math.tan(Je.camera.fov*Math.PI/360)),c=[1,2,5].flatMap(h=>[.01,.1,1,10,100,1e3,1e4].map(d=>h*d)).sort((h,d)=>h-d).filter(h=>h*l<=150).at(-1)??.01;L("scale").firstElementChild.textContent=c>=1e3?`${c/1e3} km`:c>=1?`${c} m`:`${c*100} cm`,L("scale").lastElementChild.style.width=`${c*l}px`,x.scene&&(L("drawn").textContent=v`${tt(ye.drawn)} of ${tt(x.scene.point_count)} points drawn`)}function ap(){os=new il({canvas:it,antialias:!1,preserveDrawingBuffer:!0}),ye=x.cloud=new ul(os),Je=x.mover=new ll(it,Oy),Je.groundAt=(n,e)=>ye.groundAt(n,e),it.addEventListener("webglcontextrestored",lt)}var lp=.1,mh=n=>Kt([0,0,n])[2],cp=n=>Ui([0,0,n])[2];function fl(n){x.cut=n,ye.setCut(n),L("cut").setAttribute("aria-pressed",!!n||x.tool.name==="cut"),lt()}var hp=.01,$r=()=>({low:x.scene.low.map(n=>n-hp),high:x.scene.high.map(n=>n+hp)});function pl(){let[n,e]=[x.scene.low[2],x.scene.high[2]].map(mh),{low:t,high:i}=x.cut??$r(),s=(r,o,a)=>`<div class="field"><label for="${o}">${r}</label><span><output>${ke(mh(a),1)}</output> ${Ie(x.scene.unit)}</span></div><input id="${o}" type="range" min="${n}" max="${e}" step="${lp}" value="${mh(a)}">`;x.marks=x.places.map(({clicked:r})=>({at:r})),xt(`<p class="note">${x.places.length===1?v`Click the opposite corner.`:v`Shows a part of the points alone: between two heights, and, after two clicks, between these corners on the map. Answers still count all of them.`}</p>${s(v`Not above`,"cut-high",i[2])}${s(v`Not below`,"cut-low",t[2])}<div class="row"><button id="all"${x.cut?"":" hidden"}>${v`Show all`}</button></div>`,r=>{let o=r.querySelector("#all"),a=()=>{let[l,c]=["cut-low","cut-high"].map(u=>Number(r.querySelector(`#${u}`).value));r.querySelectorAll("output").forEach((u,f)=>{u.textContent=ke([c,l][f],1)});let h=x.cut??$r(),d=[l<=n?$r().low[2]:cp(l),c>=e-lp?$r().high[2]:cp(c)];fl({low:[h.low[0],h.low[1],d[0]],high:[h.high[0],h.high[1],d[1]]}),o.hidden=!1};r.querySelectorAll("[type=range]").forEach(l=>{l.oninput=a}),o.onclick=()=>{x.places=[],fl(null),pl()}}),lt()}function up(){if(x.places.length===2){let[n,e]=x.places.map(({clicked:i})=>i),t=x.cut??$r();fl({low:[Math.min(n[0],e[0]),Math.min(n[1],e[1]),t.low[2]],high:[Math.max(n[0],e[0]),Math.max(n[1],e[1]),t.high[2]]}),x.places=[]}pl()}function gh(n){L("message").hidden=!1,L("message").innerHTML=`<strong>${Ie(n.message)}</strong><br><button>${v`Try again`}</button>`,L("message").querySelector("button").onclick=()=>{L("message").hidden=!0,x.watch()}}function at(n){if(n instanceof _n)return gh(n);L("message").hidden=!1,L("message").innerHTML=`<strong>${Ie(n.message)}</strong><br><button>${v`Close`}</button>`,L("message").querySelector("button").onclick=()=>{L("message").hidden=!0}}var dp;function Zs(n){clearTimeout(dp),L("message").hidden=!1,L("message").innerHTML=`<span id="hint" role="status">${Ie(n)}</span>`,dp=setTimeout(()=>{L("hint")&&(L("message").hidden=!0)},5e3)}var By=()=>[[`1\u2013${Math.min(wt.length,9)}${wt.length>9?", 0":""}`,v`Choose a question`],["Enter",v`Ask at the centre of the view`],["Esc",v`Close the answer`],["\u2190 \u2192 \u2191 \u2193",v`Turn`],["W A S D, Q E",v`Move; down and up`],["+ \u2212",v`Zoom`],["H",v`Whole scene`],["T",v`From above`],["C",v`Next colour`],["M",v`Next way of moving`],...He?[]:[["V",v`Before, after, change of a plan`],["B",v`Balls`],["O",v`Edges`]],...wt.some(({time:n})=>n==="hour")?[[v`Space`,v`Play the day`],["< >",v`Earlier or later`]]:[],["R",v`Measure`],["X",v`Show a part`],["P",v`Save a picture`],["L",v`Light or dark`],["?",v`This help`]],Vy=()=>He?v`Choose a question on the left. This file holds the answers that were computed when it was made, each with the command that gives the same.`:v`Choose a question on the left, then click a place. Every answer is computed by the program on this computer, and shows the command that gives the same.`,Gy=()=>`${sr?v`Orbit: one finger turns, two fingers move and zoom.`:v`Orbit: drag to turn, right drag to move, wheel to zoom.`} ${v`Walk: eyes 1.7 m above the ground. Fly: you go where you look. The arrows at the right go ahead, aside and back; drag to look around.`}`;function fp(){let n=L("keys"),e=Object.entries(us).map(([s,r])=>`<option value="${s}"${s===Mn?" selected":""}>${r}</option>`).join(""),t=Yn?"":`<p><label>${v`Language`} <select>${e}</select></label></p>`;n.innerHTML=`<h2>Belvedere</h2><p>${Vy()}</p><table>${By().map(([s,r])=>`<tr><td><kbd>${Ie(s)}</kbd></td><td>${Ie(r)}</td></tr>`).join("")}</table><p>${Gy()}</p>${t}<form method="dialog"><button autofocus>${v`Close`}</button></form>`;let i=n.querySelector("select");i&&(i.onchange=()=>io(i.value)),n.showModal()}var Hy=255;async function pp(n){if(x.results||!n?.length)return;x.results=n;for(let[t,{name:i,columns:s}]of n.entries()){for(let[r,o]of s.entries())L("color").add(new Option(o?`${i}: ${o}`:i,`result ${t} ${r}`));if(!s.length)try{let r=Math.hypot(...x.scene.low.map((o,a)=>x.scene.high[a]-o));ye.addLines(new Float32Array((await Dl(t)).body),Math.min(Math.max(r/220,.2),3)),L("meshes").hidden=!1,lt()}catch(r){at(r)}}let e=n.findIndex(t=>t.is_shown_first);e>=0&&x.tool.name==="look"&&(L("color").value=`result ${e} 0`,L("color").dispatchEvent(new Event("change")))}function Wy(n,{name:e,least:t,greatest:i,are_codes:s}){let r=e?`${n}: ${e}`:n;return s?Mu(r,e,i??1):Au(r,t??0,i??1)}async function mp(n){let[,e,t]=n.split(" ").map(Number),i=x.results[e];i.answer??=await Dl(e);let{count:s,low:r,step:o,size_m:a,columns:l,body:c}=i.answer;if(L("color").value!==n)return null;let h=new Uint8Array(c,8*s+t*s,s),d=Wy(i.name,l[t]);return s&&ye.layer(r,o,new Uint16Array(c,0,4*s),h,a?a*1.5:ye.own.size.value,d,Hy),ye.scene.visible=!i.covers_cloud,d}function ci(){if(!x.scene||!ye)return;let n=L("color").value,e=x.shownResult??kl(n,x.scene,x.answer),t=x.shownResult||x.onLayer&&n==="answer"?Tu(jn.dataset.theme==="dark"):e;ye.paint(t??kl("none"));let i=e?.legend;x.legend=i,L("legend").innerHTML=i?`<b>${Ie(i.title)}</b>`+(i.keys?i.keys.map(({color:r,text:o})=>`<div><i class="swatch" style="background:${r}"></i>${Ie(o)}</div>`).join(""):`<div class="ramp" style="background:${i.gradient}"></div><div class="ends"><span>${Ie(i.ends[0])}</span><span>${Ie(i.ends[1])}</span></div>`):"",L("outlines").getAttribute("aria-pressed")==="true"&&(L("legend").innerHTML+=`<div class="lines">${uo.map(([r,o])=>`<div><i class="swatch" style="background:rgb(${r})"></i>${o}</div>`).join("")}</div>`),lt()}function qn(n){if(L("color").value=n,x.shownResult&&(x.shownResult=null,ye.clearLayer(),ye.scene.visible=!0),n.startsWith("result ")){mp(n).then(e=>{x.shownResult=e,ci()}).catch(at);return}n==="color"&&!x.hasColors&&(x.hasColors=!0,x.loaded.forEach(e=>_h(e).catch(at))),ci()}async function _h({chunk:n,number:e}){ye.setColors(n,await Ll(e)),lt()}async function gp(){let{chunks:n,has_color:e}=x.scene;for(let t=0,i;e&&t<n.length;t++){let s=await Ll(t);if(i??=s[0],!s.some(o=>o!==i))continue;let r=L("color").querySelector("[value=none]");if(L("color").insertBefore(new Option(v`Own colours`,"color"),r),x.isColorChosen)return;x.before?x.before="color":qn("color");return}}var $y=[.02,.98];function _p(){if(!ye.chunks.length)return;let n=ye.heights($y);ye.own.heights.value.set(...n),x.scene.heights=n.map(e=>(e+x.scene.origin[2])/x.scene.metres_per_unit[2]),ci()}function vp(){let n=L("color");[...n.options].some(e=>e.value==="answer")||n.add(new Option(v`Answer`,"answer")),x.before??=n.value,qn("answer")}x.light=({azimuth_deg:n,elevation_deg:e})=>{let[t,i]=[n-(x.scene.grid_north_deg??0),e].map(s=>s*Math.PI/180);ye.setSun([Math.sin(t)*Math.cos(i),Math.cos(t)*Math.cos(i),Math.sin(i)])};x.values=n=>{ye.clearLayer(),x.onLayer=!1,ye.setValues(n),vp()};function xp(n){let e=[0,1,2].map(r=>n.reduce((o,a)=>Math.min(o,a[r]),1/0)),t=[0,1,2].map(r=>n.reduce((o,a)=>Math.max(o,a[r]),-1/0)),i=e.map((r,o)=>Math.max((t[o]-r)/65535,1e-6)),s=new Uint16Array(n.length*4);return n.forEach((r,o)=>[0,1,2].forEach(a=>{s[4*o+a]=Math.round((r[a]-e[a])/i[a])})),[e,i,s]}function vh(n,e,t,i){x.answer=i,x.onLayer=!0,ye.setValues(null),ye.layer(...xp(n),new Uint8Array(e),t,i),vp()}x.cells=n=>{let{first_center:[e,t],cell_m:i,columns:s,rows:r}=n.grid,o=new Float32Array(n.body,0,s*r),a=new Uint8Array(n.body,4*s*r),l=[],c=[];o.forEach((h,d)=>{!Number.isFinite(h)||a[d]>2||(l.push([e+d%s*i,t-Math.floor(d/s)*i,h+.12]),c.push(a[d]))}),vh(l,c,i*1.25,Wi({tells_unproven:!0},v`From where the place is seen`))};x.hourCells=n=>{let e=new Float32Array(n.body),t=Array.from({length:e.length/4},(r,o)=>[e[4*o],e[4*o+1],e[4*o+2]+.12]),i=0,s=Math.max(n.possible_hours,.1);vh(t,t.map((r,o)=>Math.round((e[4*o+3]-i)/(s-i)*255)),n.cell_m*1.3,bu(i,s))};x.changedCells=(n,e)=>{let t=n.reduce((i,s)=>Math.max(i,Math.abs(s[3])),.1);vh(n.map(([i,s,r])=>[i,s,r+.12]),n.map(i=>Math.round((i[3]/t+1)*127.5)),e*1.3,wu(t))};x.plane=n=>{let e=new Float32Array(n.body),t=Array.from({length:e.length/3},(i,s)=>[e[3*s],e[3*s+1],e[3*s+2]+.06]);ye.layer(...xp(t),new Uint8Array(t.length).fill(1),ye.own.size.value*1.4,Wi({}))};x.line=n=>{let[e,t]=x.places.map(({local:s})=>s),i=n.first_block?Ui(n.first_block.place):null;x.marks=[{line:[e,i??t],style:`stroke="${n.answer==="unproven"?"#4a86e8":"#f5a300"}" stroke-width="4"`},...i?[{line:[i,t],style:'stroke="#2f3d73" stroke-width="3" stroke-dasharray="7 5"'},{at:i,label:v`blocked here`,color:"#d1495b",down:20}]:[],{at:e,label:"A"},{at:t,label:"B"}]};var qy={Europe:[-25,34,60,72],Africa:[-20,-36,52,38],America:[-170,-56,-25,84],Asia:[25,-12,180,80],Australia:[110,-45,160,-9],Pacific:[-180,-50,180,30],Indian:[39,-50,110,20],Atlantic:[-65,-55,0,67]},Xy=([n,e,t,i],s,r)=>s>=n&&s<=t&&r>=e&&r<=i;function qr(n,e=new Date){let t=/^([+-])(\d\d):?(\d\d)$/.exec(n),i;if(n==="UTC"||n==="Z")i=0;else if(t)i=(t[1]==="-"?-1:1)*(60*Number(t[2])+Number(t[3]));else try{let r=new Intl.DateTimeFormat("en",{timeZone:n,hourCycle:"h23",year:"numeric",month:"numeric",day:"numeric",hour:"numeric",minute:"numeric"}).formatToParts(e),o=l=>Number(r.find(({type:c})=>c===l).value),a=Date.UTC(o("year"),o("month")-1,o("day"),o("hour"),o("minute"));i=Math.round((a-e.getTime())/6e4)}catch{return null}let s=new Date(e.getTime()+6e4*i);return{date:s.toISOString().slice(0,10),minutes:s.getUTCHours()*60+s.getUTCMinutes(),ahead:i}}var js=([n])=>n;function yp(n,e,t,i,s=new Date){if(n.length){let c=n.length>1;return n.includes(i)?{zone:i,why:c?js`this computer's, which fits the place; a border with other clocks is near, so look whether it is right`:js`this computer's, which fits the place`}:{zone:n[0],why:c?js`that of the place; a border with other clocks is near, so look whether it is right`:js`that of the place`}}let r=e/15,o=qy[i?.split("/")[0]];if(o&&Xy(o,e,t)&&Math.abs(qr(i,s)?.ahead/60-r)<=2)return{zone:i,why:js`this computer's, which may fit the place`};let a=Math.round(r);return{zone:`${a<0?"-":"+"}${String(Math.abs(a)).padStart(2,"0")}:00`,why:js`by the longitude of the place, without summer time: look whether it is right`}}var Xr=null;function ml(n=1){let{min:e,max:t,step:i}=L("hour"),s=x.time.minutes+n*Number(i);x.time.minutes=s>Number(t)?Number(e):s<Number(e)?Number(t)-Number(t)%Number(i):s}function gl(n){if(clearTimeout(Xr),Xr=null,L("play").setAttribute("aria-pressed",n),L("play").textContent=n?v`Pause`:v`Play`,!n){x.last?.isFirst&&x.ask();return}let e=async()=>{ml(),hi(),await x.ask(!0);for(let t=0;x.last?.elevation_deg<-6&&t<6;t++)ml();L("play").getAttribute("aria-pressed")==="true"&&(Xr=setTimeout(e,60))};Xr=setTimeout(e,0)}var ls=n=>`${String(Math.floor(n/60)).padStart(2,"0")}:${String(n%60).padStart(2,"0")}`;function hi(){L("hour").value=x.time.minutes,L("clock").textContent=ls(x.time.minutes)}function bp(){if(He){Object.assign(x.time,{date:He.date??"",zone:He.zone??""});let o=He.suns.map(a=>a.minutes);return o.length&&Object.assign(L("hour"),{min:o[0],max:o.at(-1),step:60}),x.time.minutes=o[Math.floor(o.length/2)]??720,L("date").value=x.time.date,L("zone").value=x.time.zone,L("date").disabled=L("zone").disabled=!0,hi()}let{longitude_deg:n,latitude_deg:e}=x.scene,t=Intl.DateTimeFormat().resolvedOptions().timeZone,i=n!=null,{zone:s,why:r}=i?yp(x.scene.zones,n,e,t):{zone:t,why:v`this computer's`};x.time.zone=s,x.time.zoneOf={zone:s,why:r},x.time.date||=qr(s)?.date??new Date().toISOString().slice(0,10),L("date").value=x.time.date,L("zone").value=x.time.zone,L("zones").innerHTML=(Intl.supportedValuesOf?.("timeZone")??[]).map(o=>`<option value="${o}">`).join(""),hi()}var Yy=3;async function Sp(n=new Date){let{time:e}=x,t=qr(e.zone,n);if(!t)return;let i=await An("daylight",{time:`${t.date}T${ls(t.minutes)}`,zone:e.zone}),s=i.elevation_deg<Yy,r=Math.round(i.noon_minutes/10)*10%1440;e.date=t.date,e.minutes=s?r:Math.floor(t.minutes/10)*10,L("date").value=e.date,hi();let o=s?v`It is ${ls(t.minutes)} there now, and the sun is down or near the horizon: this is noon, when it stands highest.`:v`This is now, by the clocks of the place.`;e.said={date:e.date,minutes:e.minutes,zone:e.zone,why:o}}x.ahead=()=>{let{ahead:n}=qr(x.time.zone,new Date(`${x.time.date}T12:00Z`))??{};if(n===void 0)return x.time.zone;let[e,t]=[Math.floor(Math.abs(n)/60),Math.abs(n)%60];return`UTC${n<0?"\u2212":"+"}${e}${t?`:${String(t).padStart(2,"0")}`:""}`};x.ofTime=()=>{let{date:n,minutes:e,zone:t,said:i,zoneOf:s}=x.time;return[...x.tool.time==="hour"&&i&&i.date===n&&i.minutes===e&&i.zone===t?[i.why]:[],s?.zone===t?v`Times are those of ${t}: ${hs(s.why)}.`:v`Times are those of ${t}.`].join(" ")};var Ks=()=>{(x.last||x.tool.places===0)&&x.ask()},wp=()=>Xr!==null;var Zy=500,jy=n=>Number(n.toFixed(3)),xh=n=>new URLSearchParams(n.slice(1));function Ky(){let{tool:n,time:e,places:t}=x,i=[...xh(location.hash)].filter(([o])=>["open","crs","window","up","unit"].includes(o)),s={...Object.fromEntries(i),q:n.name,d:e.date,t:ls(e.minutes),z:e.zone};e.trees!=="opaque"&&(s.trees=e.trees),L("outlines").getAttribute("aria-pressed")==="true"&&(s.edges="yes"),x.isSure&&(s.sure="yes"),x.compared&&Object.assign(s,{from:x.compared.time,fromz:x.compared.zone}),n.name!=="plan"&&t.length&&(s.p=t.map(({clicked:o})=>Kt(o).join(",")).join(";")),n.above!==void 0&&(s.h=n.above),x.cut&&(s.cut=[x.cut.low,x.cut.high].flatMap(Kt).join(",")),s.c=x.before??L("color").value,s.v=[Je.kind,...[...Je.camera.position.toArray(),...Je.orbit.target.toArray()].map(jy)].join(",");let r=o=>encodeURIComponent(o).replaceAll(/%(2C|2F|3A|3B)/g,decodeURIComponent);return`#${Object.entries(s).map(([o,a])=>`${o}=${r(a)}`).join("&")}`}function Ap(){setInterval(()=>{if(!x.isRecalled||document.hidden)return;let n=Ky();if(n===location.hash)return;let e=xh(location.hash).get("q");e&&e!==x.tool.name?history.pushState(null,"",n):history.replaceState(null,"",n)},Zy),addEventListener("popstate",()=>{x.isRecalled&&yh()})}function Jy(n){let{time:e}=x,t=/^(\d\d):(\d\d)$/.exec(n.get("t")??""),i=t?60*Number(t[1])+Number(t[2]):NaN;/^\d{4}-\d\d-\d\d$/.test(n.get("d")??"")&&(e.date=L("date").value=n.get("d")),n.get("z")&&(e.zone=L("zone").value=n.get("z")),i<1440&&(e.minutes=i),["measured","opaque","seasons"].includes(n.get("trees"))&&(e.trees=L("trees").querySelector("select").value=n.get("trees")),hi()}function Mp(n){![...L("color").options].some(({value:t})=>t===n)||n==="answer"||(x.isColorChosen=!0,x.before?x.before=n:qn(n))}function Qy(n){let[e,...t]=(n.get("v")??"").split(","),i=t.map(Number);!["orbit","walk","fly"].includes(e)||i.length!==6||!i.every(Number.isFinite)||(Je.orbit.target.set(...i.slice(3)),Je.camera.position.set(...i.slice(0,3)),Je.camera.lookAt(Je.orbit.target),L("motion").value=Je.kind=e,x.showSteps?.(),Je.orbit.enabled=e==="orbit",e==="orbit"&&Je.orbit.update(),Je.changed())}function yh(n=xh(location.hash)){x.isRecalled=!0;let e=po(n.get("q"));if(Jy(n),Qy(n),x.isSure=n.get("sure")==="yes",n.get("edges")==="yes"!=(L("outlines").getAttribute("aria-pressed")==="true")&&!L("outlines").hidden&&L("outlines").click(),x.compared=/^\d{4}-\d\d-\d\dT\d\d:\d\d$/.test(n.get("from")??"")&&n.get("fromz")?{time:n.get("from"),zone:n.get("fromz")}:null,!e)return!1;e.height&&Number.isFinite(Number(n.get("h")??NaN))&&(e.above=Number(n.get("h"))),x.choose(e.name);let t=n.get("c");if(Mp(t),t==="color"&&x.colorsKnown?.then(()=>Mp(t)),e.name==="plan")return!0;for(let i of(n.get("p")??"").split(";").map(s=>s.split(",").map(Number)))i.length===3&&i.every(Number.isFinite)&&x.pick(Ui(i));return e.places===1/0&&x.places.length>=3&&x.ask(),!0}function eb(){let n=Object.assign(document.createElement("div"),{id:"invite",textContent:sr?v`Tap anywhere to ask`:v`Click anywhere to ask`});document.body.append(n)}var bh=()=>L("invite")?.remove();async function Tp(n){let e=He||x.scene.latitude_deg!==null&&x.scene.point_count,t=x.tool.name==="look"&&L("card").hidden&&!x.pending&&!n?.some(i=>i.is_shown_first);!e||!t||!wt.some(({name:i})=>i==="shadow")||(He||await Sp(),!(x.tool.name!=="look"||!L("card").hidden)&&(x.choose("shadow"),x.whenShown=()=>requestAnimationFrame(async()=>{x.placePanels(),await Promise.allSettled(L("card").getAnimations().map(({finished:i})=>i)),x.isMoved||Oi()}),He||eb()))}function Nn(n,e,t){let i=document.createElement("a");i.href=URL.createObjectURL(e instanceof Blob?e:new Blob([e],{type:t})),i.download=n,i.click(),setTimeout(()=>URL.revokeObjectURL(i.href),1e4)}var _l=n=>n.map(e=>e.map(t=>{let i=t==null?"":String(t);return/[",\n]/.test(i)?`"${i.replaceAll('"','""')}"`:i}).join(",")).join(`
`)+`
`,vl=(n,e,t)=>JSON.stringify({type:"FeatureCollection",name:n,coordinate_reference_system:t.crs,crs:{type:"name",properties:{name:t.crs_name}},features:e.map(([i,s,r])=>({type:"Feature",geometry:{type:i,coordinates:s},properties:r}))},null,1);async function Ep(n,e,t,i,s){let r=n.width/n.clientWidth,o=document.createElement("canvas");Object.assign(o,{width:n.width,height:n.height});let a=o.getContext("2d");a.drawImage(n,0,0);let l=e.cloneNode(!0),c=getComputedStyle(document.documentElement);l.setAttribute("xmlns","http://www.w3.org/2000/svg"),l.setAttribute("width",n.clientWidth),l.setAttribute("height",n.clientHeight),l.querySelectorAll("text").forEach(d=>d.setAttribute("style",`font:600 13px sans-serif;fill:${c.getPropertyValue("--text")}`));let h=new Image;return h.src=`data:image/svg+xml;utf8,${encodeURIComponent(new XMLSerializer().serializeToString(l))}`,await h.decode().catch(()=>{}),a.drawImage(h,0,0,o.width,o.height),a.scale(r,r),a.font="600 14px sans-serif",a.fillStyle=c.getPropertyValue("--text"),a.fillText(i,14,n.clientHeight-30),a.font="12px sans-serif",a.fillText(s,14,n.clientHeight-12),t.forEach(({color:d,text:u},f)=>{a.fillStyle=d,a.fillRect(14,14+20*f,13,13),a.fillStyle=c.getPropertyValue("--text"),a.fillText(u,34,25+20*f)}),new Promise(d=>o.toBlob(d,"image/png"))}async function Cp(n){let{width:e,height:t}=n.viewBox.baseVal,i=n.cloneNode(!0);i.querySelectorAll("text").forEach(a=>{a.style.font="11px sans-serif",a.style.fill="#333"});let s=new Image;s.src=`data:image/svg+xml;utf8,${encodeURIComponent(new XMLSerializer().serializeToString(i))}`,await s.decode();let r=document.createElement("canvas");Object.assign(r,{width:3*e,height:3*t});let o=r.getContext("2d");return o.fillStyle="#fff",o.fillRect(0,0,r.width,r.height),o.drawImage(s,0,0,r.width,r.height),new Promise(a=>r.toBlob(a,"image/png"))}var tb='stroke="#1d4e89" stroke-width="2.5"',nb={building:v`Click the corners of the building.`,area:v`Click around what shall go, such as a tree or a house.`},Rp=`plan ${location.pathname}`,Js="building",xl=12;x.plan={clear:[],buildings:[],meshes:[]};x.loadedMeshes=[];x.planned=null;x.when="after";var Pp=({clear:n,buildings:e,meshes:t})=>!n.length&&!e.length&&!t.length,yl=()=>x.planned&&x.when!=="before"?x.planned.plan:null,bl=()=>x.planned!==null&&x.when==="change";function wh(){let n=yl()!==null;ye.setPlan(n?x.planned.triangles:null),ye.cleared=n?x.planned.cleared:null,(!x.answer||x.onLayer||!x.last)&&ye.setValues(null),L("plan").hidden=!x.planned,ci()}function Mh(n){x.when=L("when").value=n,wh(),(x.last||x.tool.places===0)&&x.ask()}x.setWhen=Mh;var Sh=0;async function Ip(){Sh+=1;let n=Sh;if(Pp(x.plan)){x.planned=null;return}let e=await An("plan",x.plan);if(n!==Sh)return;let t=new Float32Array(e.body.slice(0,e.triangle_bytes));x.planned={...e,triangles:t,cleared:e.points_cleared?new Uint8Array(e.body,e.triangle_bytes):null}}async function Yr(n){let e=structuredClone(x.plan);n(x.plan),x.places=[],x.marks=[];try{Pp(x.plan)||Fi(`<p class="busy">${v`Changing the scene …`}</p>`),await Ip(),sessionStorage.setItem(Rp,JSON.stringify([x.plan,x.loadedMeshes])),x.when==="before"&&(x.when=L("when").value="after"),wh(),Fi(x.plan.clear.length>e.clear.length&&x.planned?Xi(x.planned):"")}catch(t){x.plan=e,Fi(""),at(t)}lt()}x.changePlan=Yr;async function Lp(){let n=sessionStorage.getItem(Rp);!n||Yn||([x.plan,x.loadedMeshes]=JSON.parse(n),await Ip(),wh(),lt())}function Ah(){let n=x.places.map(({clicked:t})=>Kt(t)).filter((t,i,s)=>!i||t.some((r,o)=>r!==s[i-1][o]));if(n.length<3)return Fi(`<p class="note">${v`At least three corners are needed.`}</p>`);let e=n.map(([t,i])=>[t,i]);return Yr(t=>{Js==="area"?t.clear.push(e):t.buildings.push({corners:e,base:Math.min(...n.map(i=>i[2])),height_m:xl})})}async function ib(n){try{let{mesh:e}=await mu(n);x.loadedMeshes[e]=n.name,await Yr(t=>t.meshes.push(e))}catch(e){at(e)}}function Fi(n=""){let{clear:e,buildings:t,meshes:i}=x.plan,s=(a,l,c,h="")=>`<li>${Ie(c)}${h}<button data-remove="${a}" data-i="${l}" aria-label="${v`Remove ${Ie(c)}`}" title="${v`Remove`}">\xD7</button></li>`,r=[...t.map(({height_m:a},l)=>s("buildings",l,v`Building ${l+1}`,`<span><input type="number" min="0.1" step="0.5" value="${a}" data-height="${l}" aria-label="${v`Height of building ${l+1} in metres`}"> ${v`m high`}</span>`)),...i.map((a,l)=>s("meshes",l,x.loadedMeshes[a])),...e.map((a,l)=>s("clear",l,v`Cleared area ${l+1}`))].join(""),o=x.planned?.files??[];xt(`<div class="row"><button data-draw="building" aria-pressed="${Js==="building"}">${v`Draw a building`}</button><button data-draw="area" aria-pressed="${Js==="area"}">${v`Clear an area`}</button><button id="mesh">${v`Load a mesh`}</button><input id="meshfile" type="file" hidden aria-label="${v`Mesh file`}"></div>`+(Js==="building"?`<div class="field"><label for="high">${v`Height of the building`}</label><span><input id="high" type="number" min="0.1" step="0.5" value="${xl}"> m</span></div>`:"")+(n||`<p class="note">${x.places.length?mo(x.places):nb[Js]}</p>`)+(!n&&x.places.length>=3?`<div class="row"><button id="done">${v`Finish`} (Enter)</button></div>`:"")+(r?`<ul class="plan">${r}</ul><p class="note">${v`Questions are now answered with the plan. Before, after and change are at the top (V).`}</p>`:"")+(x.planned?`<h3>${v`The scene on the command line`}</h3><pre id="command">${Ie(x.planned.command)}</pre>`:"")+(o.length?`<div class="row">${o.map(({name:a},l)=>`<button data-file="${l}">${v`Save ${Ie(a)}`}</button>`).join("")}</div>`:""),a=>{let l=(h,d)=>a.querySelectorAll(h).forEach(d);l("#done",h=>{h.onclick=Ah}),l("[data-draw]",h=>{h.onclick=()=>{Js=h.dataset.draw,x.places=[],x.marks=[],Fi(),lt()}}),l("[data-remove]",h=>{h.onclick=()=>Yr(d=>d[h.dataset.remove].splice(Number(h.dataset.i),1))}),l("[data-height]",h=>{h.onchange=()=>{let d=Number.parseFloat(h.value);d>0&&Yr(u=>{u.buildings[h.dataset.height].height_m=d})}}),l("[data-file]",h=>{let{name:d,content:u}=o[h.dataset.file];h.onclick=()=>Nn(d,u,"text/plain")}),l("#high",h=>{h.onchange=()=>{xl=Math.max(Number.parseFloat(h.value)||xl,.1)}});let c=a.querySelector("#meshfile");a.querySelector("#mesh").onclick=()=>c.click(),c.onchange=()=>{c.files[0]&&ib(c.files[0])}})}function Dp(n){return n.flatMap(({clicked:e},t)=>[{at:e},...t?[{line:[n[t-1].clicked,e],style:tb}]:[]])}var sb=()=>[["metre",v`metres`],["foot",v`feet`],["centimetre",v`centimetres`],["millimetre",v`millimetres`]],rb=["y-looks-up","unit-of-room","unit-of-survey"],ob=n=>!!x.remarks?.some(e=>e.key===n),Np=()=>{let n=x.reading.up==="y";return`<button id="up" data-up="${n?"z":"y"}">${n?v`Read it with z up`:v`Read it with y up`}</button>`},kp=()=>{let n=sb().map(([e,t])=>`<option value="${e}"${e===(x.reading.unit??"metre")?" selected":""}>${t}</option>`).join("");return`<label>${v`Unit, which the files do not name`} <select id="unit">${n}</select></label>`},ab=()=>`<form id="system"><label>${v`Reference system`} <input id="system-typed" placeholder="EPSG:7415" size="12" value="${Ie(x.reading.crs??"")}"></label> <button>${v`Read it again`}</button></form>`,Op=()=>x.reading.unit||!x.scene.tells_unit&&!x.reading.crs,Up=n=>n.some(Boolean)?`<div class="row" id="reading">${n.filter(Boolean).join("")}</div>`:"";function Sl(){let{reading:n}=x;return n?Up([(n.up==="y"||ob("y-looks-up")||n.unit)&&Np(),Op()&&kp()]):""}function Zr(n){let e=r=>pu({...x.reading,...r}).catch(at),t=n.querySelector("#up");t&&(t.onclick=()=>e({up:t.dataset.up}));let i=n.querySelector("#unit");i&&(i.onchange=()=>e({unit:i.value}));let s=n.querySelector("#system");s&&(s.onsubmit=r=>{r.preventDefault(),e({crs:L("system-typed").value.trim()||null})})}function Fp(){let n=x.remarks.filter(({key:e})=>rb.includes(e));!x.reading||!n.length||x.tool.name!=="look"||!L("card").hidden||xt(`${Xi({remarks:n})}${Sl()}`,Zr)}function zp(){let{scene:n,reading:e,remarks:t=[]}=x,i=[[v`Points`,tt(n.point_count)],[v`Reference system`,n.crs],[v`Size`,n.low.map((r,o)=>Qt(n.high[o]-r,1)).join(" \xD7 ")]],s=He?"":`<p class="note">${v`To read it with another reference system or up axis, end the program and start it with --crs or --up.`}</p>`;xt(`<dl>${i.map(([r,o])=>`<dt>${r}</dt><dd>${Ie(o)}</dd>`).join("")}</dl>${e?Up([Np(),ab(),Op()&&kp()]):x.ready?s:""}${Xi({remarks:t})}`,Zr)}var lb={1:"m",.01:"cm",.001:"mm"};async function cb(n){let{scene:e}=x;Oi(),ye.own.size.value=Math.min(Math.max(e.spacing*1.7,.02),5),ye.own.most.value=180*os.getPixelRatio(),ye.own.heights.value.set(e.low[2],e.high[2]);let t=0,i=async()=>{for(;t<e.chunks.length;){let s=t++,{low:r,step:o,first:a}=e.chunks[s],l={chunk:ye.add(r,o,await uu(s),null,a),number:s};x.loaded.push(l),Ys(),x.hasColors&&await _h(l)}};await Promise.all([i(),i(),i()]),await ye.measure(e.spacing),_p(),x.isMoved||Oi(),x.isLoaded=!0,Ys()}function hb(n){let e=n.shown,[,,t]=e.metres_per_unit;x.scene={...e,title:n.title,unit:lb[t]??"ft",latitude_deg:null,heights:[e.low,e.high].map(s=>(s[2]+e.origin[2])/t)},!e.point_count&&n.scene&&Object.assign(x.scene,{low:n.scene.low,high:n.scene.high,spacing:.3}),L("title").textContent=document.title=n.title,document.title=`${n.title} \u2013 Belvedere`,L("facts").textContent=e.point_count?v`${tt(e.point_count)} points`:v`ball file`,L("crs").textContent=e.crs,x.loaded=[];let i=[["height",v`Height`],...e.classes.length>1?[["class",v`Class`]]:[],...e.has_intensity?[["intensity",v`Intensity`]]:[],["none",v`Plain`]];return L("color").replaceChildren(...i.map(([s,r])=>new Option(r,s))),qn(e.point_count?e.classes.length>1?"class":"height":"none"),x.colorsKnown=gp().catch(at),cb(e)}async function jr(){try{let n=await hu();if(L("message").hidden=!0,n.shown&&!x.scene&&(n.shown.point_count||n.scene)&&hb(n).catch(at),n.failure)throw L("progress").hidden=!0,x.failure=n.failure,Yn&&!x.scene&&(L("start").hidden=!1),new On(n.failure);for(x.meshes??=0;x.scene&&x.meshes<(n.mesh_count??0);x.meshes++)du(x.meshes).then(t=>{ye.addMesh(t),L("meshes").hidden=!1,lt()}).catch(at);if(n.scene&&x.scene&&!x.ready){Object.assign(x.scene,{...n.scene,low:x.scene.low,high:x.scene.high}),x.ready=!0,x.remarks=n.remarks,x.reading=n.reading,bp(),n.shown.point_count||Th(),L("trees").hidden=!n.scene.has_vegetation,L("outlines").hidden=He||!n.scene.roof_count;let t=()=>yh()||Tp(n.results);(He?Promise.resolve():Lp().catch(at)).then(t).then(Fp).catch(at),x.pending&&x.ask(),pp(n.results).catch(at)}L("progress").hidden=x.ready===!0;let e=L("progress").querySelector("progress");L("progress").querySelector("p").textContent=n.stage?v`Preparing: ${Zh(n.stage)}`:v`Preparing`,n.total>0?Object.assign(e,{max:n.total,value:n.done}):e.removeAttribute("value"),(!He||!x.ready)&&setTimeout(jr,x.ready?4e3:250)}catch(n){at(n)}}async function Th(){let n=L("balls").getAttribute("aria-pressed")!=="true";L("balls").setAttribute("aria-pressed",n);try{n&&!ye.balls&&ye.addBalls(await fu())}catch(e){return at(e)}ye.balls&&(ye.balls.visible=L("balls").getAttribute("aria-pressed")==="true"),lt()}async function Bp(){let n=L("outlines").getAttribute("aria-pressed")!=="true";L("outlines").setAttribute("aria-pressed",n);try{if(n&&!x.outlines){x.outlines=An("surfaces",{});let{edges:t,ridges:i,walls:s,body:r}=await x.outlines,o=new Float32Array(r),a=0;[t,i,s].forEach((l,c)=>{ye.addOutlines(o.subarray(6*a,6*(a+=l)),uo[c][0])})}}catch(t){return x.outlines=null,L("outlines").setAttribute("aria-pressed",!1),at(t)}let e=L("outlines").getAttribute("aria-pressed")==="true";ye.outlines?.forEach(t=>{t.visible=e}),ci()}x.watch=jr;var Gp='stroke="#1d4e89" stroke-width="2.5"',ub=`${Gp} stroke-dasharray="6 5"`,Eh=(n,e)=>n.map((t,i)=>t-e[i]),Vp=n=>`${ke(n,1)} m\xB2`;function db(n){let e=n.slice(1).map((a,l)=>Eh(a,n[l])),t=e.reduce((a,l)=>a+Math.hypot(...l),0),i=e.reduce((a,[l,c])=>a+Math.hypot(l,c),0),s=n.length?n.at(-1)[2]-n[0][2]:0,r=n.map(a=>Eh(a,n[0])),o=[0,0,0];return r.forEach(([a,l,c],h)=>{let[d,u,f]=r[(h+1)%r.length];o[0]+=l*f-c*u,o[1]+=c*d-a*f,o[2]+=a*u-l*d}),{length:t,flat:i,rise:s,area:Math.abs(o[2])/2,inPlane:Math.hypot(...o)/2}}function wl(){let n=x.places.map(({clicked:h})=>h),{length:e,flat:t,rise:i,area:s,inPlane:r}=db(n),o=n.slice(1).map((h,d)=>{let u=n[d];return[{line:[u,h],style:Gp},{at:h.map((f,g)=>(f+u[g])/2),label:Qt(Math.hypot(...Eh(h,u))),radius:0}]});x.marks=[...o.flat(),...n.length>2?[{line:[n.at(-1),n[0]],style:ub}]:[],...n.map(h=>({at:h}))];let a=(h,d)=>`<dt>${h}</dt><dd>${d}</dd>`,l=a(v`Length`,Qt(e))+a(v`Length on the map`,Qt(t))+a(v`Height of the last above the first`,`${i<0?"\u2212":""}${Qt(Math.abs(i))}`)+(n.length===2?a(v`Slope`,t>0?`${ke(Math.atan2(i,t)*180/Math.PI,1)}\xB0`:v`upright`):""),c=n.length<3?"":a(v`Area on the map`,Vp(s))+a(v`Area in its plane`,Vp(r));xt(`<p class="note">${n.length<2?v`Click two places for a length, more for an area.`:v`Click more places for a longer line or an area.`}</p>`+(n.length<2?"":`<dl>${l}${c}</dl><div class="row"><button id="anew">${v`Start again`}</button><button id="table">${v`Table`} (.csv)</button><button id="map">${v`Map`} (.geojson)</button></div>`),h=>{if(n.length<2)return;let d={length_m:e,map_length_m:t,rise_m:i,...n.length>2?{map_area_m2:s,plane_area_m2:r}:{}},u=n.map(Kt);h.querySelector("#anew").onclick=()=>{x.places=[],wl()},h.querySelector("#table").onclick=()=>Nn("measured.csv",_l([["x","y","z"],...u]),"text/csv"),h.querySelector("#map").onclick=()=>{let f=n.length>2?["Polygon",[[...u,u[0]]]]:["LineString",u];Nn("measured.geojson",vl("measured",[[...f,d]],x.scene),"application/geo+json")}}),lt()}var fb=n=>`<dl>${n.map(([e,t])=>`<dt>${Ie(e)}</dt><dd>${Ie(t)}</dd>`).join("")}</dl>`,Hp=254;function pb({title:n,names:e,gain:t,loss:i,of:s},r,o){let[a,l]=[r.before,r].map(({body:g})=>new Uint8Array(g)),c=g=>g===1||g===2&&r.lit!==void 0,h=l.map((g,w)=>g===Hp?g:c(g)?c(a[w])?1:2:c(a[w])?3:0),d=[0,0,0,0];for(let g of h)g!==Hp&&(d[g]+=1);o.answer=Su(n,e),o.values(h);let u=g=>r.isFirst?v`about ${tt(g)}`:tt(g),f=r.isFirst?` ${v`A first answer from a sample of them; the exact one follows …`}`:"";return`<p class="verdict">${i(u(d[3]))}, ${t(u(d[2]))}</p><p class="note">${Ie(s(tt(h.length),r))}${f}</p>`}function mb(n,e){let t=({body:l})=>{let c=new Float32Array(l);return Array.from({length:c.length/4},(h,d)=>c.subarray(4*d,4*d+4))},i=new Map(t(n.before).map(([l,c,,h])=>[`${l},${c}`,h])),s=t(n).filter(([l,c])=>i.has(`${l},${c}`)).map(([l,c,h,d])=>[l,c,h,d-i.get(`${l},${c}`)]);e.changedCells(s,n.cell_m);let r=l=>`${tt(Math.round(s.filter(c=>l(c[3])).length*n.cell_m**2))} m\xB2`,o=1/60,a=s.reduce((l,c)=>l+c[3],0)/Math.max(s.length,1);return`<p class="verdict">${a<0?"\u2212":"+"}${v`${ke(Math.abs(a),2)} hours of sun`}</p><p class="note">${v`on average on ${Ie(e.time.date)}, on the ground that is free before and after.`}</p>`+fb([[v`Loses sun`,r(l=>l<-o)],[v`Gains sun`,r(l=>l>o)],[v`Greatest loss`,`${ke(Math.max(0,-Math.min(0,...s.map(l=>l[3]))),1)} h`],[v`Greatest gain`,`${ke(Math.max(0,...s.map(l=>l[3])),1)} h`]])}function Wp(n,e,t){let i=(r,o)=>r.replace(/-o \S+(\.\w+)$/,`-o ${o}$1`),s=[i(e.before.command,"before"),i(e.command,"after"),...n.name==="sun_area"?["belvedere difference before.tif after.tif -o change.tif -o change.png"]:[]].join(`
`);return{html:n.name==="sun_area"?mb(e,t):pb(e.isPlanned?n.change:n.between,e,t),command:s}}function Jr(n){bh(),x.tool=n,x.places=[],x.marks=[],x.last=null,Kr?.abort();for(let e of L("tools").querySelectorAll("button"))e.setAttribute("aria-pressed",e.dataset.tool===n.name);if(L("tools").querySelector("p").textContent=n.hint,it.classList.toggle("asks",n.name!=="look"),L("timebar").hidden=!n.time,L("timebar").querySelectorAll(".wide, #clock, #play").forEach(e=>{e.hidden=n.time!=="hour"}),gl(!1),ye?.clearLayer(),ye?.setSun(null),x.onLayer=!1,ye?.setValues(null),x.before){let e=x.before;x.before=null,L("color").querySelector("[value=answer]")?.remove(),qn(e)}L("card").hidden=!0;for(let{name:e}of qi)L(e).setAttribute("aria-pressed",n.name===e||e==="cut"&&!!x.cut);n.name==="plan"?Fi():n.name==="measure"?wl():n.name==="cut"?pl():n.name==="crs"?zp():n.places===0?ui():(n.height||n.name!=="look"&&!L("tools").querySelector("p").offsetHeight)&&xt(`<p class="note">${Ie(n.hint)}</p>`),lt()}x.choose=n=>Jr(po(n));function Ml(n,e){let t=Wr(n,e);if(!t)return Zs(v`There is no point of the cloud at this place. Click on a point.`);bh();let i=ye.nearest(t),s=i&&(!ye.plan||i.away<(2*ye.own.size.value)**2);Ch(s?i.place:t,s?i:null)}x.click=Ml;function gb(n,{certainty:e,before:t}){if(!t)return e?n<=200?v`lit with a probability of ${Math.round(n/2)} %`:void 0:tr[n]?.[0]}var _b=[0,1,6];async function vb(n,e){let{roof:t}=await An("surfaces",{place:n});if(!t)return;let i=t.azimuth_deg===null?"":`, ${v`azimuth`} ${ke(t.azimuth_deg,1)}\xB0`;e.insertAdjacentHTML("beforeend",`<dt>${v`Plane of the roof`}</dt><dd>${v`slope`} ${ke(t.slope_deg,1)}\xB0${i}</dd><dt>${v`Its points`}</dt><dd>${v`${tt(t.points)}, which scatter by ${ke(100*t.noise_m,1)} cm`}</dd><dt>${v`Its height`}</dt><dd>${v`known to ${ke(100*t.sd_m,2)} cm (standard deviation)`}</dd>`)}function xb(n,e){let t=Kt(n),i=e?.class,s=x.tool.name==="shadow"&&x.last?gb(e?.value,x.last):void 0,r=wt.filter(({places:o,name:a})=>o===1&&a!=="look");if(x.tool.places===0&&!r.length)return Zs(v`This question is about all points. It needs no click.`);x.marks=[{at:n}],xt(`<p class="verdict" style="font-size:17px">${as(t)}</p><dl><dt>x, y, z</dt><dd>${Ie(x.scene.crs)}</dd>${x.scene.classes.length&&i!==void 0?`<dt>${v`Class`}</dt><dd>${i} ${Ie(ho[i]?.[0]??"")}</dd>`:""}${s?`<dt>${v`At the time below`}</dt><dd>${Ie(s)}</dd>`:""}</dl><pre>${t.join(",")}</pre>`+(r.length?`<h3>${v`Ask about this place`}</h3><div class="row">${r.map(({name:o,title:a})=>`<button data-about="${o}">${Ie(a)}</button>`).join("")}</div>`:""),o=>{o.querySelectorAll("[data-about]").forEach(a=>{a.onclick=()=>{x.choose(a.dataset.about),Ch(n)}}),_b.includes(i)&&x.scene.roof_count&&!He&&vb(t,o.querySelector("dl")).catch(at)}),lt()}function Ch(n,e=null){let{tool:t}=x;if(t.name==="look"||t.places===0)return xb(n,e);x.places.length>=t.places&&(x.places=[]);let i=x.places.length===0;if(x.places.push({clicked:n,local:i&&t.height?Bl(n,t.above??t.height[1]):n}),t.name==="measure")return wl();if(t.name==="cut")return up();if(t.name==="plan"){x.marks=Dp(x.places),Fi(),lt();return}let s=t.places===2?["A","B"]:[];x.marks=x.places.map(({local:r},o)=>({at:r,label:s[o]})),t.places===1/0?(x.places.forEach(({local:r},o)=>{o&&x.marks.push({line:[x.places[o-1].local,r],style:'stroke="#1d4e89" stroke-width="2.5"'})}),xt(`<p class="note">${mo(x.places)}</p>${x.places.length<3?"":`<div class="row"><button id="done">${v`Ask`} (Enter)</button></div>`}`,r=>{let o=r.querySelector("#done");o&&(o.onclick=()=>ui())})):x.places.length===t.places?ui():xt(`<p class="note">${v`Now click B.`}</p>`),lt()}x.pick=Ch;var Xp=n=>n.samples&&x.scene.tells_unproven&&!He&&!(n.time&&x.time.trees==="seasons");function yb(n){if(!n.certainty)return n;let e=n.body.byteLength/2;return{...n,probabilities:n.body.slice(e),body:n.body.slice(0,e)}}function Yp(){let{date:n,zone:e,minutes:t,trees:i}=x.time;return{date:n,zone:e,clock:ls(t),trees:i==="opaque"?i:{[i]:"by_date"}}}var $p=n=>!!(n.between&&x.compared&&!bl()&&!He),Kr;async function ui(n=!1){let{tool:e}=x;if(e.name==="plan")return Ah();if(qi.includes(e))return;Kr?.abort();let t=Kr=new AbortController;if(x.failure){xt(`<p class="verdict">${v`No answer`}</p><p class="note">${Ie(x.failure)}</p>`);return}if(!x.ready){xt(`<p class="busy">${v`The answer comes as soon as the scene is ready.`}</p>`),x.pending=!0;return}if(e.time&&x.scene.latitude_deg===null){xt(`<p class="verdict">${v`The location is unknown`}</p><p class="note">${v`The sun needs to know where on earth the cloud lies, but its file names no reference system. Open it again with the reference system of the cloud.`}</p>`);return}if(e.time&&!x.time.date){xt(`<p class="verdict">${v`The date is missing`}</p><p class="note">${v`Choose a day below.`}</p>`);return}if(e.time&&!x.time.zone){xt(`<p class="verdict">${v`The time zone is missing`}</p><p class="note">${v`Write one below, such as Europe/Amsterdam or +02:00.`}</p>`);return}let i=x.places.map(({local:a})=>Kt(a));x.last=e.places===0?x.last:null;let s=setTimeout(()=>{x.last||xt(`<p class="busy">${v`Asking …`}</p>`)},150),r=performance.now(),o=async(a,l)=>{let c=x.isSure&&Xp(e)&&!bl()&&!$p(e)?{probability:!0}:{},h=yb(await An(a,{...l,...c},t.signal,yl()));return e.change&&bl()?{...h,isPlanned:!0,before:await An(a,l,t.signal)}:$p(e)?{...h,before:await An(a,{...l,...x.compared},t.signal,yl())}:h};try{let[a,l]=e.ask(i,Yp());if(e.samples&&x.scene.samples_first&&!He){let h=await o(a,{...l,points:"sample"});if(t.signal.aborted)return;let d={...h,isFirst:!0,took:performance.now()-r};if(n&&(x.last=d),qp(e,d,i),n||(e.time&&await new Promise(u=>setTimeout(u,250)),t.signal.aborted))return}let c=await o(a,l);if(t.signal.aborted)return;c.took=performance.now()-r,x.last=c,e.places===1/0&&(x.marks=x.marks.concat({line:[x.places.at(-1).local,x.places[0].local],style:'stroke="#1d4e89" stroke-width="2.5"'})),qp(e,c,i)}catch(a){if(a.name==="AbortError")return;if(a instanceof _n)return gh(a);xt(`<p class="verdict">${v`No answer`}</p><p class="note">${Ie(a.message)}</p>${Sl()}`,Zr)}finally{clearTimeout(s),Kr===t&&(Kr=null)}}x.ask=ui;var bb=n=>n.split(`
`).map(e=>e.split(" ").map(t=>`<span>${Ie(t)}</span>`).join(" ")).join(`
`),Sb=(n=[],e=[])=>[...n,...e.filter(({text:t})=>!n.some(i=>i.text===t))];function qp(n,e,t){let i=e.before?Wp(n,e,x):n.show(e,x),s=i.html??i,r=t.length===1?`<dl><dt>${v`Place`}</dt><dd>${as(t[0])}</dd></dl>`:"",a=[...(e.before?null:n.rows?.(e,x))?[`<button data-save="csv">${v`Table`} (.csv)</button>`]:[],...n.properties&&!e.before?[`<button data-save="geojson">${v`Map`} (.geojson)</button>`]:[],`<button data-save="png">${v`Picture`} (.png)</button>`].join(""),l=n.time?x.ofTime():"",c=Xp(n)&&!e.before?`<button id="sure" aria-pressed="${x.isSure}">${v`Show how sure each answer is`}</button>`:"",h=n.between&&!He&&!e.isPlanned?`<button id="compare" aria-pressed="${!!x.compared}">${x.compared?v`Compare no longer`:v`Compare this time with another`}</button>`:"",d=c||h?`<div class="row">${c}${h}</div>`:"";xt(`${s}${d}${l?`<p class="note" id="oftime">${Ie(l)}</p>`:""}${Xi({remarks:Sb(e.remarks,x.remarks)})}${Sl()}${r}<h3>${v`The same on the command line`}</h3><pre id="command">${bb(i.command??e.command)}</pre><div class="row"><button data-save="copy">${v`Copy command`}</button>${a}</div><p class="note" id="took">${He?v`Stored in this file.`:v`Answered in ${Math.round(e.took)} ms.`}</p>`,u=>{i.after?.(u),Zr(u);let f=u.querySelector("#compare");f&&(f.onclick=()=>{let[,{time:w,zone:p}]=n.ask(t,Yp());x.compared=x.compared?null:{time:w,zone:p},x.compared&&Zs(v`Choose another date or time below.`),ui()});let g=u.querySelector("#sure");g&&(g.onclick=()=>{x.isSure=!x.isSure,ui()}),u.querySelectorAll("[data-save]").forEach(w=>{w.onclick=()=>wb(w,n,e,t)})}),x.whenShown?.(),x.whenShown=null,lt()}async function wb(n,e,t,i){let s=`${e.name}-${x.scene.title.replace(/\..*$/,"")}`,r=n.dataset.save;if(r==="copy")await navigator.clipboard?.writeText(L("command").textContent).catch(()=>{}),n.textContent=v`Copied`;else if(r==="csv")Nn(`${s}.csv`,_l(e.rows(t,x)),"text/csv");else if(r==="geojson"){let[o,a]=e.geometry?.(i)??["Point",i[0]];Nn(`${s}.geojson`,vl(s,[[o,a,e.properties(t)]],x.scene),"application/geo+json")}else{let o=L("card").querySelector("figure svg");Nn(`${s}.png`,o?await Cp(o):await Rh())}}async function Rh(){await fh();let n=x.legend?.keys??[],e=[x.scene.title,x.legend?.title].filter(Boolean).join(": ");return Ep(it,L("marks"),n,e,`${x.scene.crs}; ${v`scale bar`} ${L("scale").textContent}`)}var Zp=n=>/\.(vpc|json|geojson)$/i.test(new URL(n,location.href).pathname),jp=n=>({points:n.reduce((e,{points:t,low:i,high:s})=>e+(t??20*(s[0]-i[0])*(s[1]-i[1])),0),side:300,tiles:n,low:[0,1].map(e=>n.reduce((t,{low:i})=>Math.min(t,i[e]),1/0)),high:[0,1].map(e=>n.reduce((t,{high:i})=>Math.max(t,i[e]),-1/0))}),Kp=(n,[e,t,i,s])=>n.filter(({low:r,high:o})=>r[0]<=i&&o[0]>=e&&r[1]<=s&&o[1]>=t);var Jp="demo.laz",Mb=700,Ab=38e8,Tb=7e8;function Eb(){let e=navigator.userAgentData?.mobile??/iPhone|iPad|Android/.test(navigator.userAgent)?Tb:Math.min(Ab,(navigator.deviceMemory??8)*5e8);return Math.floor(e/Mb)}var Cb=()=>new URLSearchParams(location.hash.slice(1));function Qp(n,{points:e,most:t,low:i,high:s,side:r=1/0,tiles:o=[]}){let a=[s[0]-i[0],s[1]-i[1]],l=o.length?o.reduce((M,E)=>M+(E.high[0]-E.low[0])*(E.high[1]-E.low[1]),0):a[0]*a[1],c=Math.min(Math.sqrt(l*t*.9/e),r),h=a.map(M=>Math.min(c,M)),d=[0,1].map(M=>i[M]+(a[M]-h[M])/2),u=260/Math.max(...a),f=L("part");L("progress").hidden=!0,L("start").hidden=!1,L("start").firstElementChild.hidden=!0,f.hidden=!1;let g=M=>ke(M/1e6,1),[w,p]=h.map(Math.round);f.querySelector("p").textContent=o.length?v`The catalogue has ${tt(o.length)} tiles. Choose the part to open: ${w} by ${p}, in the unit of the files.`:v`The files have ${g(e)} million points, and this browser has room for ${g(t)} million. Choose the part to open: ${w} by ${p}, in the unit of the file.`;let m=f.querySelector("svg");m.setAttribute("viewBox",`-1 -1 ${a[0]*u+2} ${a[1]*u+2}`);let S=({low:[M,E],high:[_,A]})=>`<rect x="${(M-i[0])*u}" y="${(s[1]-A)*u}" width="${(_-M)*u}" height="${(A-E)*u}" class="all"/>`;m.innerHTML=`${(o.length?o:[{low:i,high:s}]).map(S).join("")}<rect width="${h[0]*u}" height="${h[1]*u}" class="window"/>`;let R=M=>{[0,1].forEach(_=>{d[_]=Math.min(Math.max(M[_],i[_]),s[_]-h[_])});let E=m.querySelector(".window");E.setAttribute("x",(d[0]-i[0])*u),E.setAttribute("y",(s[1]-d[1]-h[1])*u),f.querySelector("output").textContent=v`${d.map(Math.round).join(", ")} to ${d.map((_,A)=>Math.round(_+h[A])).join(", ")}`},T=M=>{let E=m.getScreenCTM().inverse(),{x:_,y:A}=new DOMPoint(M.clientX,M.clientY).matrixTransform(E);R([i[0]+_/u-h[0]/2,s[1]-A/u-h[1]/2])};m.onpointerdown=M=>{m.setPointerCapture(M.pointerId),T(M)},m.onpointermove=M=>{M.buttons&&T(M)},m.onkeydown=M=>{let E={ArrowLeft:[-1,0],ArrowRight:[1,0],ArrowUp:[0,1],ArrowDown:[0,-1]}[M.key];E&&(M.preventDefault(),R(d.map((_,A)=>_+E[A]*Math.max(h[A]/10,a[A]/100))))},R(d),f.querySelector("button").onclick=()=>{if(!n([...d,...d.map((M,E)=>M+h[E])]))return at(new Error(v`No tile of the catalogue lies there.`));f.hidden=!0,L("start").hidden=!0,L("progress").hidden=!1}}function Qr(n,e){let t=L("crs-typed").value.trim(),i=L("window-typed").value.split(/[\s,;]+/).filter(Boolean).map(Number);if(i.length&&(i.length!==4||i.some(Number.isNaN))){at(new Error(v`The window needs four numbers: west, south, east, north.`));return}L("start").hidden=!0,L("progress").hidden=!1,x.failure=null;let s={up:L("up-chosen").value||"z",unit:L("unit-chosen").value||null,crs:t||null},r={max_points:Eb(),reading:s,...i.length?{window:i}:{}};if(n.length===1&&n[0].url&&Zp(n[0].url))return Rb(n[0].url,r,e);let o=a=>(lo(n,{...r,window:a},()=>{}),!0);lo(n,r,a=>Qp(o,a)),e()}async function Rb(n,e,t){try{let i=await lu(n),s=r=>{let o=Kp(i,r).map(({address:a})=>Al(a));return o.length?(lo(o,{...e,window:r},()=>{}),t(),!0):!1};if(!e.window)return Qp(s,{...jp(i),most:e.max_points});if(!s(e.window))throw new Error(v`No tile of the catalogue lies there.`)}catch(i){L("progress").hidden=!0,L("start").hidden=!1,at(i)}}var Al=n=>({name:decodeURIComponent(new URL(n,location.href).pathname.split("/").pop()),url:new URL(n,location.href).href});async function Pb(){let n=async e=>{let[t,i]=[0,0];for await(let s of e.values())t+=1,i+=(await s.getFile()).size;return[t,i]};try{let e=await navigator.storage.getDirectory(),[t,i]=await n(await e.getDirectoryHandle("scenes"));if(!t)return;let s=Math.ceil(i/1e6);L("kept").hidden=!1,L("kept").querySelector("span").textContent=t===1?v`1 scene is kept in this browser (${s} MB): the same files open in a moment.`:v`${t} scenes are kept in this browser (${s} MB): the same files open in a moment.`,L("kept").querySelector("button").onclick=async()=>{await e.removeEntry("scenes",{recursive:!0}),L("kept").hidden=!0}}catch{}}function em(n){L("start").hidden=!1;let e=L("languages");e.append(...Object.entries(us).map(([o,a])=>new Option(a,o))),e.value=Mn,e.onchange=()=>io(e.value);let t=o=>{let a=[...o].map(l=>({name:l.name,file:l}));a.length&&Qr(a,n)};L("choose").onchange=()=>t(L("choose").files),L("demo").onclick=async()=>{try{Qr([{name:Jp,file:await(await fetch(Jp)).blob()}],n)}catch(o){at(o)}};let i=document.querySelector('meta[name="tile"]');if(i){let o=Object.assign(document.createElement("button"),{id:"tile",textContent:i.content});L("demo").after(" ",o),o.onclick=()=>{L("crs-typed").value=i.dataset.crs,Qr([Al(i.dataset.file)],n)}}L("address").onsubmit=o=>{o.preventDefault();let l=Object.entries({open:"address-typed",crs:"crs-typed",window:"window-typed",up:"up-chosen",unit:"unit-chosen"}).map(([c,h])=>[c,L(h).value.trim()]).filter(([,c])=>c);history.replaceState(null,"",`#${new URLSearchParams(l)}`),Qr([Al(L("address-typed").value.trim())],n)},L("cancel").hidden=L("open").hidden=!1,L("cancel").onclick=L("open").onclick=()=>location.replace(location.pathname),addEventListener("dragover",o=>{o.preventDefault(),document.body.classList.add("dropping")}),addEventListener("dragleave",o=>{o.relatedTarget||document.body.classList.remove("dropping")}),addEventListener("drop",o=>{o.preventDefault(),document.body.classList.remove("dropping"),L("start").hidden||t(o.dataTransfer.files)}),Pb();let s=Cb();L("crs-typed").value=s.get("crs")??"",L("window-typed").value=s.get("window")??"",s.get("up")==="y"&&(L("up-chosen").value="y"),L("unit-chosen").value=s.get("unit")??"",(L("up-chosen").value||L("unit-chosen").value||L("crs-typed").value)&&!s.get("open")&&(L("address").parentElement.open=!0,Zs(v`Choose the files again: they are read as chosen below.`)),s.get("open")&&Qr([Al(s.get("open"))],n)}async function tm(){if(navigator.serviceWorker)try{let n=await navigator.serviceWorker.register("service-worker.js");!crossOriginIsolated&&!navigator.serviceWorker.controller&&(await navigator.serviceWorker.ready,n.active&&!sessionStorage.getItem("reloaded")&&(sessionStorage.setItem("reloaded","yes"),location.reload()))}catch{}}var cs=0,Ph=n=>v`Viewpoint ${n+1}`;function nm(n){return{...n,height:null,places:0,samples:!1,hint:v`Choose a viewpoint: its view is in this file.`,ask:()=>["seen",{viewpoint:cs}],show(e,t){let{viewpoints:i}=He;t.marks=i.map(({place:r},o)=>({at:Ui(r),label:o===cs?v`${Ph(o)}, shown`:Ph(o),color:o===cs?"#d1495b":void 0})),e.viewpoint=v`From viewpoint ${cs+1}`;let s=i.map((r,o)=>`<option value="${o}"${o===cs?" selected":""}>${Ph(o)}</option>`).join("");return{html:`<div class="field"><label for="viewpoint">${v`Viewpoint`}</label><select id="viewpoint">${s}</select></div><p class="note">${Ie(as(e.place))}</p>${n.show(e,t)}`,after(){L("viewpoint").onchange=()=>{cs=Number(L("viewpoint").value),t.ask()}}}},geometry:()=>["Point",He.viewpoints[cs].place]}}function im(n){jn.dataset.theme=n,L("theme").textContent=n==="dark"?v`Light`:v`Dark`,x.last&&x.tool.name==="seen"&&!x.last.certainty&&(x.answer=Wi(x.last,x.last.viewpoint)),ci()}function Tl(){L("steps").hidden=Je.kind==="orbit",L("steps").querySelectorAll("[data-fly]").forEach(n=>{n.hidden=Je.kind!=="fly"})}x.showSteps=Tl;x.placePanels=()=>{jn.style.setProperty("--bar",`${L("bar").offsetHeight}px`),jn.style.setProperty("--time",`${L("timebar").offsetHeight}px`)};function Ib(){let n=null;it.addEventListener("pointerdown",i=>{n=i.isPrimary?[i.clientX,i.clientY]:null,L("crosshair").hidden=!0}),it.addEventListener("pointerup",i=>{let s=i.pointerType==="touch"?12:5;n&&i.button===0&&Math.hypot(i.clientX-n[0],i.clientY-n[1])<s&&x.scene&&Ml(i.clientX,i.clientY),n=null}),it.addEventListener("pointercancel",()=>{n=null}),it.addEventListener("dblclick",()=>{x.tool.places===1/0&&x.places.length>=3&&ui()});let e=!1;it.addEventListener("pointermove",i=>{e||i.buttons||!x.scene||(e=!0,op(()=>{e=!1;let s=Wr(i.clientX,i.clientY);L("where").textContent=s?as(Kt(s)):""}))}),L("color").onchange=()=>{x.isColorChosen=!0,qn(L("color").value)},L("when").onchange=()=>Mh(L("when").value),L("motion").onchange=()=>{Je.setKind(L("motion").value),Tl()};for(let i of L("steps").querySelectorAll("button")){let s,r=()=>Je.go(...i.dataset.go.split(",").map(Number));i.onpointerdown=()=>{r(),s=setInterval(r,60)},i.onpointerup=i.onpointerleave=i.onpointercancel=()=>clearInterval(s),i.oncontextmenu=o=>o.preventDefault(),i.onclick=o=>{o.detail===0&&r()}}L("home").onclick=()=>{L("motion").value="orbit",Oi(),Tl()},L("top").onclick=()=>{L("motion").value="orbit",Oi(!0),Tl()},L("theme").onclick=()=>im(jn.dataset.theme==="dark"?"light":"dark"),L("picture").onclick=async()=>Nn(`${x.scene.title.replace(/\..*$/,"")}.png`,await Rh());for(let{name:i}of qi)L(i).onclick=()=>x.scene&&x.choose(x.tool.name===i?wt[0].name:i);L("balls").onclick=Th,L("outlines").onclick=Bp,L("meshes").onclick=()=>{let i=L("meshes").getAttribute("aria-pressed")!=="true";L("meshes").setAttribute("aria-pressed",i),ye.meshes.forEach(s=>{s.visible=i}),lt()},L("help").onclick=fp,L("play").onclick=()=>gl(!wp()),L("date").onchange=()=>{x.time.date=L("date").value,Ks()},L("hour").oninput=()=>{x.time.minutes=Number(L("hour").value),hi(),Ks()},L("trees").querySelector("select").onchange=i=>{x.time.trees=i.target.value,Ks()},L("zone").onchange=()=>{x.time.zone=L("zone").value.trim(),Ks()},addEventListener("resize",ph);let t=new ResizeObserver(x.placePanels);t.observe(L("bar")),t.observe(L("timebar")),addEventListener("keydown",Lb)}function Ih(n){n.selectedIndex=(n.selectedIndex+1)%n.options.length,n.dispatchEvent(new Event("change"))}function Lb(n){if(/INPUT|SELECT|TEXTAREA/.test(n.target.tagName)||n.ctrlKey||n.metaKey||n.altKey||L("keys").open)return;let e=n.target.tagName==="BUTTON",t={ArrowLeft:[.08,0],ArrowRight:[-.08,0],ArrowUp:[0,.06],ArrowDown:[0,-.06]},i={w:[1,0,0],s:[-1,0,0],a:[0,-1,0],d:[0,1,0],q:[0,0,-1],e:[0,0,1]},s={h:"home",t:"top",b:"balls",o:"outlines",p:"picture",l:"theme",r:"measure",x:"cut","?":"help"},r=n.key.length===1?n.key.toLowerCase():n.key;if(!(e&&(r==="Enter"||r===" "))){if(t[r])Je.turn(...t[r]);else if(i[r])Je.go(...i[r]);else if(s[r])L(s[r]).hidden||L(s[r]).click();else if(r==="+"||r==="=")Je.zoom(.85);else if(r==="-")Je.zoom(1.18);else if(r==="c")Ih(L("color"));else if(r==="m")Ih(L("motion"));else if(r==="v"&&!L("plan").hidden)Ih(L("when"));else if(r==="Escape")Jr(wt[0]);else if(r===" "&&x.tool.time==="hour")L("play").click();else if((r==="<"||r===","||r===">"||r===".")&&x.tool.time==="hour")ml(r==="<"||r===","?-1:1),hi(),Ks();else if(r==="Enter")x.tool.places===1/0&&x.places.length>=3&&L("crosshair").hidden?ui():(L("crosshair").hidden=!1,Ml(it.clientWidth/2,it.clientHeight/2));else if(/^[0-9]$/.test(r)&&wt[(Number(r)+9)%10])Jr(wt[(Number(r)+9)%10]);else return;n.preventDefault()}}function Db(){Kh(document.body),L("tools").innerHTML=`<h2>${v`Questions`}</h2>${wt.map((n,e)=>`<button data-tool="${n.name}" aria-pressed="false" title="${n.title} (${(e+1)%10})">${n.icon}<span>${n.title}</span><small aria-hidden="true">${n.short}</small><kbd aria-hidden="true">${(e+1)%10}</kbd></button>`).join("")}<p></p>`;for(let n of L("tools").querySelectorAll("button"))n.onclick=()=>x.choose(n.dataset.tool);if(He){L("balls").hidden=!0;let n=wt.find(({name:e})=>e==="seen");n&&Object.assign(n,nm({...n}))}matchMedia("(prefers-color-scheme: dark)").matches&&im("dark");try{ap()}catch{at(new Error(v`This browser has no WebGL 2, which the page needs. Try another browser, or switch on hardware acceleration.`));return}Ib(),ph(),Jr(wt[0]),Yn?(em(jr),tm()):jr(),He||Ap()}Db();})();
