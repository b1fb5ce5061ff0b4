import java.io.File;
import org.sunflow.SunflowAPI;
import org.sunflow.core.display.FileDisplay;
import org.sunflow.core.parser.SCParser;

/**
 * Renders a scene with the Sunflow that Debian ships (packages libsunflow-java and libjanino-java). Its own program refuses .sc
 * files, but their reader is still in the library. Included files must be inlined first (jaspe convert does).
 *
 * <pre>
 * export CLASSPATH=$(echo /usr/share/java/{sunflow,janino,commons-compiler}*.jar | tr ' ' ':'):benches/sunflow
 * javac -d benches/sunflow benches/sunflow/Render.java
 * jaspe bench scenes a.sc b.sc --peer 'java -Xmx4G Render {scene} {out}'
 * </pre>
 */
public class Render {
    public static void main(String[] arguments) {
        String scene = new File(arguments[0]).getAbsolutePath();
        String folder = new File(scene).getParent() + File.separator;
        SunflowAPI api = new SunflowAPI();
        api.searchpath("include", folder);
        api.searchpath("texture", folder);
        if (!new SCParser().parse(scene, api)) System.exit(1);
        api.render(SunflowAPI.DEFAULT_OPTIONS, new FileDisplay(arguments[1]));
    }
}
